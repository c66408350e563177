"""The report answers its questions from the log alone, in one page that needs nothing else."""

import html
import json
import re

import numpy as np
import pytest
from report_data import line_of, page_data
from rewrite import rewrite
from synthetic import Known, Synthetic, write_log

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.report import report
from uvms_analysis.report.questions import QUESTIONS
from uvms_analysis.summary import summarise
from uvms_core import topics

GROUPS = [group for question in QUESTIONS for group in question.groups]
KNOWN = Known(duration=6.0, path_duration=4.0)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    write_log(folder / "run.mcap", KNOWN)
    (folder / "summary.json").write_text(json.dumps({"completed": True, "wall_s": 2.0}))
    report(folder / "run.mcap")
    return folder


@pytest.fixture(scope="module")
def page(folder):
    return (folder / "report.html").read_text(encoding="utf-8")


def figure(page, name):
    """Text of the cell of a figure."""
    row = re.search(rf'<th scope="row">{re.escape(name)}</th><td[^>]*>(.*?)</td>', page)
    return re.sub("<[^>]*>", "", row.group(1))


def without(source, target, *dropped):
    """A copy of a log that has some topics under names that nobody knows."""
    names = {f"/{topic.name}" for topic in dropped}

    def renamed(topic, text):
        return (f"{topic}_of_old" if topic in names else topic), text

    return rewrite(source, target, schema=renamed)


def test_every_question_has_its_plots_and_nothing_is_from_elsewhere(folder, page):
    for question in QUESTIONS:
        assert f'<section id="{question.key}">' in page
    shown = re.findall(r'data-plot="([^"]+)"', page)
    assert sorted(shown) == sorted(page_data(page)["plots"])
    assert len(shown) > 60
    assert not re.search(r"""(src|href)=["'](?!data:|#)""", page)
    assert "url(" not in page
    assert list(folder.glob("*.png")) == []


def test_the_lines_are_the_samples_of_the_log(page):
    """The loop sees no error but that of navigation along east, the truth a sine along x."""
    data, known = page_data(page), Synthetic(KNOWN)
    time, east = line_of(data, "tool_error_east", "seen by the loop")
    assert east == pytest.approx(30.0, abs=1e-2)
    assert time[0] == 1.0
    assert np.diff(time) == pytest.approx(0.05)
    time, north = line_of(data, "tool_error_north", "true")
    assert north == pytest.approx(20.0 * np.sin(np.pi * time), abs=1e-2)
    time, roll = line_of(data, "roll", "true")
    assert roll == pytest.approx(2.0 * np.sin(2 * np.pi * time / 4.0), abs=1e-5)
    name = known.vehicle.thruster_names[1]
    time, thrust = line_of(data, f"thrust_{name}", "allocated")
    assert thrust == pytest.approx(10.0 * np.sin(0.3 * time + 1.0), abs=1e-5)
    time, value = line_of(data, "lyapunov", "V")
    assert value == pytest.approx(4.0 * 0.5 ** (2.0 * time), rel=1e-6)


def test_the_page_describes_the_run(page):
    for text in ("synthetic, seed 7", "git_revision", "abc", "config.yaml"):
        assert text in page
    assert figure(page, "simulated by wall time") == "3 ×"
    assert figure(page, "position estimate off the truth") == "30 mm rms"
    assert figure(page, "tool off its target, seen by the loop, greatest").endswith(" mm")
    # 30 mm along an axis of 20 mm standard deviation, nothing along the two others
    nees = figure(page, "squared position error over its covariance, per axis; 1 is right")
    assert nees == "0.75"
    assert (
        figure(page, "position error within the filter's 3 σ, all axes".replace("'", "&#x27;"))
        == "100 %"
    )


def test_every_figure_has_a_unit_or_says_why_it_is_missing(page):
    cells = re.findall(r'<table class="figures">(.*?)</table>', page, re.DOTALL)
    assert len(cells) == len(QUESTIONS)
    values = [
        re.sub("<[^>]*>", "", value)
        for cell in cells
        for value in re.findall(r'data-label="value">(.*?)</td>', cell)
    ]
    assert len(values) == sum(len(question.metrics) for question in QUESTIONS)
    for value in values:
        assert re.fullmatch(r"-?[\d.e+-]+ \S.*|missing: \S.*|0\.75", value), value  # NEES has none


def test_the_energy_of_the_run_and_of_each_thruster_is_shown(folder, page):
    found = summarise(folder / "run.mcap", wall_s=None)
    assert figure(page, "electrical energy") == f"{found['energy']['total_wh']:.4g} Wh"
    main = found["energy"]["thrusters_wh"]["main"]
    assert figure(page, "main").startswith(f"{main:.4g} Wh")
    # 1/1024 of the battery a second, by its own account
    assert figure(page, "share of the battery that was used") == "0.5859 %"
    assert figure(page, "how long a full battery lasts at this rate") == "0.2844 h"
    _, left = line_of(page_data(page), "battery_left", "left")
    assert left == pytest.approx(100.0 * (1.0 - np.arange(7.0) / 1024.0))


def test_an_old_log_says_why_its_battery_is_missing(folder, tmp_path):
    log = without(folder / "run.mcap", tmp_path / "run.mcap", topics.BATTERY_STATE)
    page = html.unescape(report(log).read_text(encoding="utf-8"))
    why = "the log has no battery_state, although the vehicle has a battery"
    assert figure(page, "share of the battery that was used") == f"missing: {why}"
    assert f"No figure: {why}" in page
    assert figure(page, "electrical energy").endswith(" Wh")


def test_an_old_log_says_what_it_lacks_and_shows_the_rest(folder, tmp_path):
    lacking = (topics.STABILITY, topics.APPLIED_THRUST, topics.DISTURBANCE_BUDGET)
    log = without(folder / "run.mcap", tmp_path / "run.mcap", *lacking)
    page = html.unescape(report(log).read_text(encoding="utf-8"))
    assert "No figure: has no control/stability: its controller does not report it" in page
    assert figure(page, "V").startswith("missing: has no control/stability")
    assert figure(page, "oldest command that the plant used").startswith("missing: has no topic")
    assert "not shown: given: log" in page
    data = page_data(page)
    assert "lyapunov" not in data["plots"]
    budget = data["plots"]["budget_restoring_force"]
    assert [line["name"] for line in budget["lines"]] == ["true"]
    assert "roll" in data["plots"]


def test_a_failed_run_has_its_reasons_first(tmp_path):
    write_log(tmp_path / "run.mcap", Known(duration=6.0, path_duration=4.0, error=0.9))
    text = html.unescape(report(tmp_path / "run.mcap").read_text(encoding="utf-8"))
    text = re.sub(r"<(style|script)\b.*?</\1>", "", text, flags=re.DOTALL)
    assert "Outcome: invalid. This run is not completed." in text
    reasons = summarise(tmp_path / "run.mcap", wall_s=None)["reasons"]
    assert any("the end effector was within 0.2 m of its path for" in one for one in reasons)
    assert max(map(text.index, reasons)) < text.index('class="card"') < text.index("data-plot=")


def test_a_run_without_truth_is_shown_by_its_estimates_and_says_so(folder, tmp_path):
    truth = (topics.TRUE_ODOMETRY, topics.TRUE_JOINT_STATES, topics.TRUE_DISTURBANCE)
    page = report(without(folder / "run.mcap", tmp_path / "run.mcap", *truth))
    page = html.unescape(page.read_text(encoding="utf-8"))
    assert "The limits are judged by estimates: the log has no truth." in page
    names = {line["name"] for plot in page_data(page)["plots"].values() for line in plot["lines"]}
    assert "estimated" in names
    assert not [name for name in names if "true" in name]
    assert figure(page, "tool off its target, seen by the loop").endswith(" mm rms")
    assert figure(page, "tool off its target, true").startswith("missing: has no topic")
    assert figure(page, "roll, greatest").startswith("missing: ")


def test_what_users_wrote_is_escaped(tmp_path):
    with LogWriter(tmp_path / "run.mcap") as log:
        log.metadata("uvms", {"scenario": "<script>x</script>", "seed": 1})
    page = report(tmp_path / "run.mcap", tmp_path / "out").read_text(encoding="utf-8")
    assert "<script>x" not in page
    assert "&lt;script&gt;x&lt;/script&gt;" in page


def test_plots_that_cannot_be_drawn_say_why(tmp_path):
    LogWriter(tmp_path / "run.mcap").close()
    page = report(tmp_path / "run.mcap").read_text(encoding="utf-8")
    assert page.count("No figure: ") == len(GROUPS)
    assert "Outcome: invalid" in page
    assert page_data(page)["plots"] == {}


def test_a_broken_off_log_is_reported(tmp_path, folder):
    data = (folder / "run.mcap").read_bytes()
    (tmp_path / "run.mcap").write_bytes(data[: len(data) // 2])
    page = report(tmp_path / "run.mcap").read_text(encoding="utf-8")
    assert "The log is not complete: the writer was stopped early" in page
    assert "not completed" in page


def test_a_folder_that_cannot_be_made_is_named(folder, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match="cannot be written"):
        report(folder / "run.mcap", tmp_path / "file" / "out")


def damaged_log(folder, tmp_path, whole: bytes, damaged: bytes):
    assert len(whole) == len(damaged)
    data = (folder / "run.mcap").read_bytes()
    (tmp_path / "run.mcap").write_bytes(data.replace(whole, damaged, 1))
    return tmp_path / "run.mcap"


def test_a_damaged_attachment_costs_only_what_needs_it(tmp_path, folder):
    log = damaged_log(folder, tmp_path, b"environment:", b"environm\xff\xfft:")
    page = html.unescape(report(log).read_text(encoding="utf-8"))
    assert "No figure: " in page
    assert "its attachment 'vehicle.yaml' is damaged" in page
    assert "navigation_north" in page_data(page)["plots"]


@pytest.mark.parametrize(
    ("name", "whole", "other", "reason"),
    [
        ("vehicle.yaml", "environment:", "environmxxt:", "environment: Field"),
        ("vehicle.yaml", "environment:", "environment[", "is not valid YAML"),
        ("config.yaml", "seed: 7", "seed: [", "is not valid YAML"),
        ("config.yaml", "scenario: synthetic\nseed: 7", "- 7", "is not a mapping"),
    ],
)
def test_an_attachment_that_says_something_else_is_named(
    tmp_path, folder, name, whole, other, reason
):
    def change(attachments):
        text = attachments[name].decode()
        assert whole in text
        return attachments | {name: text.replace(whole, other, 1).encode()}

    log = RunLog.open(rewrite(folder / "run.mcap", tmp_path / "run.mcap", attachments=change))
    assert log.fault == ""
    read = log.configuration if "config" in name else lambda: Analysis(log).vehicle
    with pytest.raises(LogError, match=re.escape(f"its attachment {name!r}")) as fault:
        read()
    assert reason in str(fault.value)
