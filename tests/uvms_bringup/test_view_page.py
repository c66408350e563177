"""The page of a run in a headless browser, the shared file, pictures and movies."""

from dataclasses import replace

import numpy as np
import pytest
from browser import browser_tab
from PIL import Image
from viewed import pixel_of, served, short_run

from uvms_bringup.cli import main
from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.cameras import view_of
from uvms_bringup.viewer.elements import world_pose
from uvms_bringup.viewer.export import export, frame_times
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.movie import held, write_movie
from uvms_bringup.viewer.overview import Plot
from uvms_bringup.viewer.page import LogPage, Site
from uvms_bringup.viewer.picture import picture
from uvms_bringup.viewer.plot_strip import HEIGHT_PX, plot_strip
from uvms_bringup.viewer.scene_model import SceneModel

HULL = np.array([0.96, 0.74, 0.16])
SIZE = (1280, 720)
"""Of the browser's window."""
VIEW = (SIZE[0], SIZE[1] - HEIGHT_PX)
"""Of the 3-D view above the plots."""
MANY = 300
"""Pixels that a vehicle in view has at the least."""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return short_run(tmp_path_factory.mktemp("view") / "run")


@pytest.fixture(scope="module")
def source(run):
    return LogSource(run)


@pytest.fixture
def tab(tmp_path):
    with browser_tab(tmp_path / "profile") as found:
        yield found


def yellow(image):
    """Where the picture shows the hull: much more red than blue, and green between."""
    red, green, blue = (image[..., n].astype(int) for n in range(3))
    return (red - blue > 60) & (green - blue > 30) & (red >= green)


def green(image):
    """Where the picture of the page shows the starboard light, outside its panels."""
    red, green, blue = (image[60:430, 320:930, n].astype(int) for n in range(3))
    found = np.zeros(image.shape[:2], dtype=bool)
    found[60:430, 320:930] = (green - red > 90) & (green - blue > 60)
    return found


def test_the_page_loads_shows_the_vehicle_and_moves_it_when_scrubbed(source, tab):
    with served(LogPage(source, Site(port=0))) as page:
        tab.open(page.address)
        tab.wait_for_text("UVMS: manipulation")
        (first,) = tab.wait(lambda: _settled(tab), "a vehicle in the picture")
        light = pixel_of(page, VIEW, world_pose("estimated/light_starboard", page.places)[0])
        assert np.linalg.norm(np.argwhere(green(first)).mean(axis=0)[::-1] - light) < 10.0
        before = page.drawing.position_of("estimated/link_1").copy()
        page.player.jump(7.5)
        tab.wait_for_text("7.50 s of 8 s")
        tab.wait(lambda: _scene_changed(first, tab.picture()), "a change in the scene")
        assert np.linalg.norm(page.drawing.position_of("estimated/link_1") - before) > 1e-4
        expected = source.moment(7.5).estimated.position
        assert np.abs(page.drawing.position_of("estimated") - expected).max() < 1e-6
        page.player.jump(1.0)
        page.player.speed = 0.25
        tab.press("Play")
        tab.wait_for_text("Pause")
        tab.press("Pause")
        tab.wait_for_text("Play")
        assert not page.player.playing
        assert 1.0 < page.player.time < 8.0
        page.player.jump(7.0)
        page.player.speed = 1.0
        tab.press("Play")
        tab.wait_for_text("8.00 s of 8 s")
        assert tab.complaints == []


def _scene_changed(first, now):
    """Whether anything has changed around the vehicle, outside the panels."""
    part = np.abs(now.astype(int) - first)[:280, 330:930]
    return (part.max(axis=2) > 40).sum() > 30


def _settled(tab):
    """The second of two pictures in a row with the same vehicle, in a tuple; else nothing."""
    one, other = tab.picture(), tab.picture()
    if yellow(one).sum() > MANY and abs(int(yellow(one).sum()) - int(yellow(other).sum())) < 50:
        return (other.astype(int),)
    return ()


def test_the_shared_file_opens_without_server_and_network(source, tab, tmp_path):
    file = export(source, tmp_path / "run.html", frames=30)
    assert file.stat().st_size < 3e6
    assert "<script src=" not in file.read_text(encoding="utf-8")[:2000]
    tab.offline()
    tab.open(file.as_uri())
    tab.wait(lambda: yellow(tab.picture()).sum() > MANY, "a vehicle in the picture")
    place = "document.querySelector('#plots .now').style.transform"
    early = tab.evaluate(place)
    tab.wait(lambda: tab.evaluate(place) != early, "the mark in the plots to go with the time")
    titles = tab.evaluate("[...document.querySelectorAll('#plots b')].map(e => e.innerText)")
    assert [title.split(",")[0] for title in titles] == [p.title for p in source.overview.plots()]
    assert tab.complaints == []


SMOOTH = (
    "document.querySelectorAll('canvas')[1].getContext('webgl2').getContextAttributes().antialias"
)


def test_the_page_declines_smooth_edges_where_a_processor_draws_unless_asked(source, tab):
    with served(LogPage(source, Site(port=0))) as page:
        for query, is_smooth in (("", False), ("?quality=high", True), ("?quality=low", False)):
            tab.open(f"{page.address}/{query}")
            tab.wait_for_text("UVMS: manipulation")
            assert tab.evaluate(SMOOTH) is is_smooth
    asked = LogPage(source, Site(port=0, quality="low"))
    assert asked.address.endswith("/?quality=low")
    asked.close()


def test_plots_stand_under_the_view_follow_the_time_and_can_be_put_away(source, tab):
    with served(LogPage(source, Site(port=0))) as page:
        tab.open(page.address)
        tab.wait_for_text("UVMS: manipulation")
        marks = "[...document.querySelectorAll('#plots .now')].map(e => e.style.transform)"
        for time in (2.0, 6.0):
            page.player.jump(time)
            there = [f"translateX({100 * time / source.end_s:.2f}%)"] * len(source.overview.plots())
            there = [place.replace(".00", "").replace(".50", ".5") for place in there]
            tab.wait(lambda there=there: tab.evaluate(marks) == there, "marks at the time shown")
        bottom = "document.getElementById('root').getBoundingClientRect().bottom"
        top = "document.getElementById('plots').getBoundingClientRect().top"
        assert tab.evaluate(bottom) == tab.evaluate(top) < SIZE[1]
        for width in (1280, 800):
            tab.width(width, 720)
            assert tab.evaluate("document.documentElement.scrollWidth") == width
        tab.press("hide plots")
        assert tab.evaluate(bottom) == SIZE[1]
        tab.press("show plots")
        assert tab.evaluate(bottom) < SIZE[1]


def test_a_few_great_values_do_not_press_a_curve_flat():
    times = np.arange(200.0)
    values = np.sin(times)[:, None]
    values[0] = 500.0
    _, strip = plot_strip(times, [Plot("disturbance", "N", ("external",), values)])
    assert "-1 to 3 N; beyond it 500" in strip
    assert "500" not in plot_strip(times[1:], [Plot("a", "N", ("b",), values[1:])])[1]


def test_a_run_of_fifteen_minutes_has_no_more_frames_than_asked():
    times = frame_times(0.0, 902.0, 1500)
    assert (len(times), times[0], times[-1]) == (1500, 0.0, 902.0)
    assert np.allclose(np.diff(frame_times(0.0, 1.0, 1500)), 0.05)


def test_a_picture_shows_the_vehicle_with_port_and_starboard(source):
    model = SceneModel(source.setting)
    image = np.asarray(picture(model, source.moment(5.0), "top", "run", (320, 180)))
    assert yellow(image).sum() > MANY
    red, green, blue = (image[..., n].astype(int) for n in range(3))
    port = np.argwhere((red > 150) & (green < 60) & (blue < 60))
    starboard = np.argwhere((green > 100) & (red < 70) & (blue < 90))
    assert len(port)
    assert len(starboard)
    bow = np.argwhere(yellow(image))
    # from above, with the bow up in the picture, port is left and starboard right
    assert port[:, 1].mean() < bow[:, 1].mean() < starboard[:, 1].mean()


def test_the_command_writes_picture_and_movies(run, source, tmp_path, capsys):
    still = tmp_path / "at.png"
    assert main(["view", str(run), "--picture", str(still), "--at", "4"]) == 0
    assert Image.open(still).size == (1280, 720)
    assert str(still) in capsys.readouterr().out
    gif = write_movie(source, tmp_path / "run.gif", "wide", (0.0, 1.0), speed=5.0)
    with Image.open(gif) as movie:
        assert movie.n_frames == 2
    mp4 = write_movie(source, tmp_path / "run.mp4", "tool", (0.0, 0.2), speed=2.5)
    assert mp4.read_bytes()[4:8] == b"ftyp"


def test_the_camera_of_a_movie_stands_still_unless_the_vehicle_goes_away(source):
    model, times = SceneModel(source.setting), np.array([0.0, 4.0, 8.0])
    first = view_of("bow", model, model.all_places(source.moment(0.0)))
    assert np.array_equal(held(source.moment, model, times, "bow").look_at, first.look_at)

    def far(time):
        moment = source.moment(time)
        away = replace(moment.estimated, position=moment.estimated.position + [time, 0.0, 0.0])
        return replace(moment, estimated=away)

    assert held(far, model, times, "bow") == "bow"


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ([], "name a log, or --live"),
        (["{run}", "--live"], "one of the two"),
        (["{run}", "--movie", "{folder}/a.avi"], "ends in one of .gif, .mp4"),
        (["{run}", "--picture", "{folder}/no/a.png"], "cannot be written"),
        (["{run}", "--export", "{folder}/no/a.html"], "cannot be written"),
        (["{run}", "--picture", "{folder}/a.png", "--at", "99"], "from 0 to 8 s"),
        (["{folder}/nothing.mcap"], "No such file"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(run, tmp_path, capsys, words, why):
    words = [word.format(run=run, folder=tmp_path) for word in words]
    assert main(["view", *words]) == 2
    complaint = capsys.readouterr().err
    assert why in complaint
    assert complaint.count("\n") == 1


def test_an_unknown_time_span_of_a_movie_is_refused(source, tmp_path):
    with pytest.raises(ViewError, match="from 0 to 8 s"):
        write_movie(source, tmp_path / "a.gif", "wide", (2.0, 1.0))
