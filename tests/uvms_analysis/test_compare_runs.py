"""Runs side by side: what differs, in which unit, and a page with the figures."""

import json
import re

import pytest
from synthetic import Known, write_log

from uvms_analysis.compare import compare
from uvms_analysis.compare.compare import names_of
from uvms_analysis.compare.table import as_text, differences, unit
from uvms_analysis.errors import LogError


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
    assert page.count("data:image/png;base64,") == 4
    assert not re.findall(r'(?:src|href)="(?!data:)', page)
    assert len(list((tmp_path / "out").glob("compare_*.png"))) == 4


def test_a_figure_that_a_log_does_not_allow_says_why(logs, tmp_path):
    from uvms_analysis.log.writer import LogWriter

    LogWriter(tmp_path / "empty" / "run.mcap").close()
    found = compare([logs / "one", tmp_path / "empty"], tmp_path / "out")
    assert "No figure: log" in found.page.read_text()


def test_the_summary_beside_a_log_is_used(logs, tmp_path):
    (logs / "two" / "summary.json").write_text(json.dumps({"outcome": "given up", "wall_s": 7.0}))
    rows = {row.name: row for row in compare([logs / "one", logs / "two"], tmp_path).rows}
    (logs / "two" / "summary.json").unlink()
    assert rows["wall_s"].values == (None, 7.0)


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


def test_names_tell_the_runs_apart(tmp_path):
    paths = [tmp_path / "a" / "x" / "run.mcap", tmp_path / "b" / "x" / "run.mcap"]
    assert names_of(paths) == ("a/x", "b/x")
    assert names_of([tmp_path / "first.mcap", tmp_path / "x" / "run.mcap"]) == ("first", "x")


def test_one_run_is_refused(logs, tmp_path):
    with pytest.raises(LogError, match="give at least two runs"):
        compare([logs / "one"], tmp_path)
