"""The page of a report in a headless browser: sizes, colours, plots, keyboard, paper, 3-D."""

import base64
import re

import numpy as np
import pytest
from browser import browser_tab
from viewed import short_run

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.read import RunLog
from uvms_bringup.cli import main

WIDTHS = (400, 1300, 2500)
CONTRAST = 4.5
"""Of text to its ground, WCAG 2.1 AA."""
GRAPHIC = 3.0
"""Of lines to their ground, the same."""
MANY = 300
"""Pixels that a vehicle in view has at the least."""
TAB_KEY, ENTER, LEFT, RIGHT, HOME = 9, 13, 37, 39, 36

CUT_OFF = """[...document.querySelectorAll("body *")]
  .filter((e) => e.clientWidth && e.scrollWidth > e.clientWidth + 1)
  .map((e) => `${e.tagName}.${e.className}: ${e.scrollWidth} > ${e.clientWidth}`)"""
BEYOND = """[...document.querySelectorAll("body *")]
  .filter((e) => e.getBoundingClientRect().right > innerWidth + 1 && e.clientWidth)
  .map((e) => `${e.tagName}.${e.className}`)"""
COLOURS = """(() => {
  const parts = (text) => text.match(/[\\d.]+/g).map(Number);
  const ground = (e) => {
    for (; e; e = e.parentElement) {
      const [r, g, b, a] = parts(getComputedStyle(e).backgroundColor);
      if (a === undefined || a === 1) return [r, g, b];
    }
    return [255, 255, 255];
  };
  const texts = [...document.querySelectorAll("body *")].filter((e) => e.checkVisibility()
    && [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim()));
  return texts.map((e) => [e.tagName + "." + e.className,
    parts(getComputedStyle(e).color).slice(0, 3), ground(e)]);
})()"""
CONTROLS = """[...document.querySelectorAll("a, button, input, [tabindex='0']")]
  .filter((e) => e.checkVisibility())"""
FOCUSED = f"""(() => {{
  const e = document.activeElement, style = getComputedStyle(e);
  const all = {CONTROLS};
  return [all.indexOf(e), style.outlineStyle, parseFloat(style.outlineWidth)];
}})()"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = short_run(tmp_path_factory.mktemp("report") / "run", duration=4.0)
    assert main(["report", str(folder)]) == 0
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with browser_tab(tmp_path_factory.mktemp("browser") / "profile") as tab:
        tab.offline()
        yield tab


@pytest.fixture
def tab(browser, run):
    opened(browser, run / "report.html")
    yield browser
    assert browser.complaints == []
    assert {address.split(":")[0] for address in browser.requests} <= {"file", "data", "blob"}


def opened(tab, page):
    tab.width(1300)
    tab.colours("light")
    tab.open(f"file://{page}")
    tab.evaluate(
        "document.querySelectorAll('.fold.closed button').forEach((button) => button.click())"
    )
    assert tab.evaluate("report.drawAll()") > 60


def contrast(one, two):
    """Of two colours, (3,) each 0 to 255: WCAG 2.1."""

    def luminance(colour):
        c = np.asarray(colour, dtype=float) / 255.0
        linear = np.where(c <= 0.03928, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
        return linear @ [0.2126, 0.7152, 0.0722]

    high, low = sorted((luminance(one), luminance(two)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def test_the_measure_of_contrast_is_that_of_the_standard():
    assert contrast((0, 0, 0), (255, 255, 255)) == pytest.approx(21.0)
    assert contrast((119, 119, 119), (255, 255, 255)) == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("width", WIDTHS)
def test_nothing_is_cut_off_or_beyond_the_page(tab, width):
    tab.width(width)
    settled = """[...report.figures.values()].every(({u, element}) =>
      u.width === element.querySelector(".canvas").clientWidth)"""
    tab.wait(lambda: tab.evaluate(settled), "the plots in their new size")
    tab.wait(lambda: tab.evaluate(CUT_OFF) == [], f"nothing cut off: {tab.evaluate(CUT_OFF)}")
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    assert tab.evaluate(BEYOND) == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_and_lines_stand_out_from_their_ground(tab, scheme):
    tab.colours(scheme)
    found = tab.evaluate(COLOURS)
    assert len(found) > 200
    poor = [(name, contrast(text, ground)) for name, text, ground in found
            if contrast(text, ground) < CONTRAST]  # fmt: skip
    assert poor == []
    names = [*(f"--line-{k}" for k in range(7)), "--plan", "--limit", "--event"]
    style = "getComputedStyle(document.documentElement).getPropertyValue('{}').trim()"
    card, *lines = (tab.evaluate(style.format(name)) for name in ("--card", *names))
    for line in lines:
        assert contrast(rgb(line), rgb(card)) >= GRAPHIC, line


def rgb(text):
    assert re.fullmatch("#[0-9a-f]{6}", text), text
    return [int(text[k : k + 2], 16) for k in (1, 3, 5)]


def test_dark_and_light_differ_in_page_and_plots(tab):
    def looks():
        style = "getComputedStyle(document.body).backgroundColor"
        ink = ("(() => {const u = report.figures.get('roll').u, c = u.ctx.canvas;"
               "return [...u.ctx.getImageData(0, 0, c.width, c.height).data].filter("
               "(v, k) => k % 4 === 3 && v > 0).length + ':' + [...u.ctx.getImageData("
               "0, 0, c.width, c.height).data].reduce((a, b) => a + b, 0)})()")  # fmt: skip
        return tab.evaluate(style), tab.evaluate(ink)

    light = looks()
    tab.colours("dark")
    dark = tab.wait(lambda: (now := looks())[1] != light[1] and now, "plots in other colours")
    assert dark[0] != light[0]


def test_the_plots_show_the_values_of_the_log(tab, run):
    seen = Analysis(RunLog.open(run / "run.mcap"))
    time = float(seen.truth.time[37])
    tab.evaluate(f"report.point({time!r})")
    index = int(np.searchsorted(seen.allocation.time, time - 1e-6))
    name = seen.vehicle.thruster_names[0]
    expected = {
        "roll": seen.rpy_deg[37, 0],
        "tool_down": seen.end_effector[37, 2],
        f"thrust_{name}": seen.allocation.thrust[index, 0],
        "budget_external_force": np.linalg.norm(seen.disturbance.external[37, :3]),
    }
    for key, value in expected.items():
        first = f"report.figures.get('{key}').u.data"
        shown = tab.evaluate(f"values.at({first}[0], {first}[1], {time!r})")
        assert shown == pytest.approx(value, rel=1e-6, abs=1e-9), key


def test_the_cursor_says_time_and_values_by_keyboard_and_zooms(tab, run):
    roll = Analysis(RunLog.open(run / "run.mcap")).rpy_deg[:, 0]
    tab.evaluate("document.querySelector('#plot-roll .canvas').focus()")
    tab.evaluate("document.querySelector('#plot-roll').scrollIntoView()")
    in_view = "report.figures.get('roll').isInView"
    tab.wait(lambda: tab.evaluate(in_view), "the plot in view")
    tab.key("ArrowRight", RIGHT)
    assert tab.evaluate("document.getElementById('now').textContent") == "cursor at 2.02 s"
    tab.key("ArrowLeft", LEFT)
    assert tab.evaluate("document.getElementById('now').textContent") == "cursor at 2.00 s"
    shown = tab.evaluate("document.querySelector('#plot-roll .legend output').textContent")
    assert float(shown.removesuffix(" deg")) == pytest.approx(roll[40], rel=1e-3)
    window = "['from', 'to'].map((id) => Number(document.getElementById(id).value))"
    whole = tab.evaluate(window)
    tab.key("+", 187, "+")
    assert tab.evaluate(window) == pytest.approx([1.0, 3.0], abs=0.1)
    scale = "(() => {const s = report.figures.get('pitch').u.scales.x; return [s.min, s.max]})()"
    tab.wait(lambda: np.allclose(tab.evaluate(scale), [1.0, 3.0], atol=0.1), "the others follow")
    tab.key("Home", HOME)
    assert tab.evaluate(window) == whole
    scale = "(() => {const s = report.figures.get('lyapunov').u.scales.y; return [s.min, s.max]})()"
    low, high = tab.evaluate(scale)
    assert 0.0 < low < high


def test_lines_are_hidden_by_their_buttons(tab):
    button = "document.querySelector('#plot-roll .legend button')"
    tab.evaluate(f"{button}.click()")
    assert tab.evaluate(f"{button}.getAttribute('aria-pressed')") == "false"
    assert tab.evaluate("report.figures.get('roll').u.series[1].show") is False


def test_every_control_is_reached_by_tab_and_shows_its_focus(tab):
    count = tab.evaluate(f"{CONTROLS}.length")
    assert count > 150
    tab.evaluate("document.body.focus()")
    reached = set()
    for _ in range(count + 5):
        tab.key("Tab", TAB_KEY)
        place, style, width = tab.evaluate(FOCUSED)
        if place >= 0:
            assert style != "none"
            assert width >= 2
            reached.add(place)
    assert reached == set(range(count))


def test_a_section_is_folded_by_key_and_unfolded_on_paper(tab):
    button = "document.querySelector('.fold button[aria-expanded]')"
    tab.evaluate(f"{button}.focus()")
    tab.key("Enter", ENTER, "\r")
    assert tab.evaluate(f"{button}.getAttribute('aria-expanded')") == "false"
    folded = "document.querySelector('.fold > .folded').checkVisibility()"
    assert tab.evaluate(folded) is False
    tab.call("Emulation.setEmulatedMedia", media="print")
    assert tab.evaluate(folded) is True
    tab.call("Emulation.setEmulatedMedia", media="")


def test_paper_is_light_and_has_pages(tab):
    tab.colours("dark")
    data = base64.b64decode(tab.call("Page.printToPDF", printBackground=True)["data"])
    assert data.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", data)) > 5
    assert tab.evaluate("document.documentElement.dataset.paper") is None
    tab.evaluate("dispatchEvent(new Event('beforeprint'))")
    ground = tab.evaluate("getComputedStyle(document.body).getPropertyValue('--card').trim()")
    assert ground == "#ffffff"
    assert tab.evaluate("Math.max(...[...report.figures.values()].map((f) => f.u.width))") == 430
    tab.evaluate("dispatchEvent(new Event('afterprint'))")


def test_the_run_is_seen_in_3d(tab):
    """In a small window, as it is drawn without a graphics card here."""
    tab.width(640, 520)
    tab.evaluate("document.getElementById('open-scene').click()")
    frame = "document.querySelector('.scene iframe')"
    assert tab.evaluate(f"{frame}.title") == "The run in 3-D"
    tab.evaluate(f"{frame}.scrollIntoView({{block: 'end'}})")
    top = int(tab.evaluate(f"{frame}.getBoundingClientRect().top")) + 3

    def hull():
        """Yellow: the notices of the page are orange."""
        red, green, blue = (tab.picture()[top:, :, n].astype(float) for n in range(3))
        return ((red - blue > 60) & (green > 0.62 * red) & (red >= green)).sum() > MANY

    tab.wait(hull, "a vehicle in the 3-D view")


def test_several_runs_come_on_one_page(run, browser, tmp_path, capsys):
    copy = tmp_path / "copy"
    copy.mkdir()
    (copy / "run.mcap").write_bytes((run / "run.mcap").read_bytes())
    assert main(["report", str(run), str(copy), "--output", str(tmp_path / "both")]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(tmp_path / "both" / "compare.html")
    opened(browser, tmp_path / "both" / "compare.html")
    names = "report.figures.get('roll').plot.lines.map((line) => line.name)"
    assert browser.evaluate(names) == ["run: true", "copy: true"]
    for width in WIDTHS:
        browser.width(width)
        browser.wait(lambda: browser.evaluate(CUT_OFF) == [], f"nothing cut off at {width} px")
    assert browser.complaints == []


def test_a_picture_of_several_runs_is_refused(run, capsys):
    assert main(["report", str(run), str(run), "--picture", "it.png"]) == 2
    assert "--picture is of one run; 2 are given" in capsys.readouterr().err
