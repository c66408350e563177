"""Runs side by side: what differs, in which unit, and a page with the plots."""

import json
import re

import pytest
from report_data import page_data
from synthetic import Known, write_log

from uvms_analysis.compare import compare
from uvms_analysis.compare.compare import names_of
from uvms_analysis.compare.page import best_of
from uvms_analysis.compare.table import as_text, differences, unit
from uvms_analysis.errors import LogError
from uvms_analysis.report.metrics import BY_KEY
from uvms_analysis.summary import summarise
from uvms_bringup.cli import main


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    for name, known in (
        ("one", Known(duration=6.0, path_duration=4.0)),
        ("two", Known(duration=6.0, path_duration=4.0, with_path=False)),
    ):
        write_log(folder / name / "run.mcap", known)
    return folder


def test_runs_are_compared_by_folder_or_by_file(logs, tmp_path):
    found = compare([logs / "one", logs / "two" / "run.mcap"], tmp_path / "out")
    assert found.names == ("one", "two")
    rows = {row.name: row.values for row in found.rows}
    assert rows["end_effector_target"] == ("path", "reference")
    assert "roll_deg.max" not in rows  # the same in both
    page = found.page.read_text()
    assert not re.findall(r'(?:src|href)="(?!data:|#)', page)
    plot = page_data(page)["plots"]["roll"]
    assert [line["name"] for line in plot["lines"]] == ["one: true", "two: true"]
    assert [line["colour"] for line in plot["lines"]] == [0, 1]


def test_a_plot_that_a_log_does_not_allow_says_why(logs, tmp_path):
    from uvms_analysis.log.writer import LogWriter

    LogWriter(tmp_path / "empty" / "run.mcap").close()
    found = compare([logs / "one", tmp_path / "empty"], tmp_path / "out")
    page = found.page.read_text()
    assert "No figure: empty: has no topic" in page
    assert "not shown: empty: not in its log" in page
    assert [line["name"] for line in page_data(page)["plots"]["roll"]["lines"]] == ["one: true"]


def test_the_summary_beside_a_log_is_used(logs, tmp_path):
    (logs / "two" / "summary.json").write_text(json.dumps({"outcome": "given up", "wall_s": 7.0}))
    rows = {row.name: row for row in compare([logs / "one", logs / "two"], tmp_path).rows}
    (logs / "two" / "summary.json").unlink()
    assert rows["wall_s"].values == (None, 7.0)


def test_the_best_is_one_of_the_completed_runs_and_nobody_where_all_are_alike():
    low, high = BY_KEY["roll_deg.max"], BY_KEY["authority_left"]
    neither = BY_KEY["external.force_rms_n"]
    assert best_of(low, [3.0, 2.0, 1.0], [True, True, False]) == (1,)
    assert best_of(high, [3.0, 2.0, 1.0], [True, True, True]) == (0,)
    assert best_of(low, [3.0, 1.0, 1.0], [True, True, True]) == (1, 2)
    assert best_of(low, [1.0, 1.0], [True, True]) == ()
    assert best_of(low, [None, 1.0], [True, True]) == ()
    assert best_of(neither, [1.0, 2.0], [True, True]) == ()


def test_the_page_tells_differences_from_the_first_run(tmp_path):
    for name, roll in (("calm", 2.0), ("rolling", 3.0)):
        write_log(tmp_path / name / "run.mcap", Known(duration=6.0, roll_deg=roll))
        beside = summarise(tmp_path / name / "run.mcap", wall_s=1.0)
        beside |= {"outcome": "completed", "completed": True, "reasons": []}
        (tmp_path / name / "summary.json").write_text(json.dumps(beside))
    page = compare([tmp_path / "calm", tmp_path / "rolling"], tmp_path).page.read_text()
    row = re.search(r'<th scope="row">roll, greatest, deg</th>(.*?)</tr>', page).group(1)
    assert "★ best: 2<" in row
    assert "3 (+1, +50 %)" in row


def test_differences_units_and_ratio():
    one = {"roll_deg.max": 2.0, "same": 1, "run_id": "a", "check.faults": ["x"]}
    two = {"roll_deg.max": 3.0, "same": 1, "run_id": "b", "check.faults": [], "thrust_rms_n": 1.0}
    roll, thrust = differences([one, two])
    assert (roll.name, roll.unit, roll.values, roll.ratio) == ("roll_deg.max", "deg", (2, 3), 1.5)
    assert (thrust.unit, thrust.values, thrust.ratio) == ("N", (None, 1.0), None)
    assert as_text(("a", "b"), [roll]).splitlines() == [
        "field         unit  a  b",
        "roll_deg.max  deg   2  3",
    ]
    assert unit("self_disturbance.moment_rms_nm") == "N m"
    assert unit("outcome") == ""


def damaged(folder, found, work):
    """A copy of a run whose log went through `work`, with the summary of the whole one."""
    log = folder / "run.mcap"
    folder.mkdir()
    log.write_bytes(work(bytearray((found / "run.mcap").read_bytes())))
    summary = summarise(found / "run.mcap", wall_s=1.0)
    (folder / "summary.json").write_text(json.dumps({**summary, "thrust_rms_n": 12345.0}))
    return folder


def flipped(data):
    data[len(data) // 3] ^= 1
    return data


@pytest.mark.parametrize("work", [flipped, lambda data: data[: len(data) // 2]])
def test_a_damaged_log_is_told_and_its_old_summary_left_aside(logs, tmp_path, capsys, work):
    bad = damaged(tmp_path / "bad", logs / "one", work)
    assert main(["compare", str(logs / "one"), str(bad), "--output", str(tmp_path / "out")]) == 0
    out = capsys.readouterr().out
    page = (tmp_path / "out" / "compare.html").read_text()
    for text in (out, page):
        assert re.search(r"bad: its log is not complete: \S", text)
        assert "bad: summary.json is left aside, and its values are made from the log" in text
        assert "12345" not in text


def test_a_whole_log_keeps_its_summary(logs, tmp_path):
    same = damaged(tmp_path / "same", logs / "one", lambda data: data)
    found = compare([logs / "one", same], tmp_path / "out")
    assert not any("left aside" in text for text in found.warnings)
    assert {row.name: row.values[1] for row in found.rows}["thrust_rms_n"] == 12345.0


def test_vehicle_and_scenario_are_named_even_where_they_are_the_same(logs, tmp_path):
    vehicle, scenario = compare([logs / "one", logs / "two"], tmp_path).rows[:2]
    assert (vehicle.name, scenario.name) == ("vehicle", "scenario")
    assert vehicle.values[0] == vehicle.values[1] is not None


def test_lines_stay_within_the_terminal_and_fields_of_one_run_are_left_out():
    one = {"reasons": ["x" * 300], "events": ["y" * 90], "node_counters.a.refused": 1, "n": 1.0}
    two = {"reasons": [], "events": ["z" * 200], "node_counters.b.refused": 2, "n": 2.0}
    rows = list(differences([one, two]))
    assert [row.name for row in rows] == ["reasons", "events", "n"]
    lines = as_text(("first", "second"), rows, 80).splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[1].count("…") == 1
    assert lines[3].split() == ["n", "1", "2"]


def test_a_campaign_is_not_taken_for_a_run(logs, tmp_path):
    (tmp_path / "campaign.yaml").write_text("campaign: mine\n")
    with pytest.raises(LogError, match=r"is a campaign without logs; run it with --logs all, or"):
        compare([tmp_path, logs / "one"], tmp_path / "out")
    own = tmp_path / "logs" / "run-1"
    own.mkdir(parents=True)
    (own / "run.mcap").touch()
    with pytest.raises(LogError, match=rf"give runs of it, such as {re.escape(str(own))}$"):
        compare([tmp_path, logs / "one"], tmp_path / "out")


def test_names_tell_the_runs_apart(tmp_path):
    paths = [tmp_path / "a" / "x" / "run.mcap", tmp_path / "b" / "x" / "run.mcap"]
    assert names_of(paths) == ("a/x", "b/x")
    assert names_of([tmp_path / "first.mcap", tmp_path / "x" / "run.mcap"]) == ("first", "x")


def test_one_run_is_refused(logs, tmp_path):
    with pytest.raises(LogError, match="give at least two runs"):
        compare([logs / "one"], tmp_path)
