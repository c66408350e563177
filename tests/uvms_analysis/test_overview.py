"""`uvms info` and `uvms topics` say of a log what was written into it, and nothing else."""

import json

import numpy as np
import pytest
from command_line import main
from synthetic import ARM, COUPLING, RESTORING, Known, write_log

from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.overview import topic_rows, value_rows
from uvms_core import topics
from uvms_core.signals import NANOSECONDS, Wrench

KNOWN = Known(duration=6.0, path_duration=4.0, namespace="auv")


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    write_log(path, KNOWN)
    return path


def test_a_topic_has_its_rate_and_its_span(path):
    rows = {row.topic: row for row in topic_rows(RunLog.open(path))}
    odometry = rows["/auv/odometry"]
    assert odometry.messages == 121
    assert (odometry.first_s, odometry.last_s) == (0.0, 6.0)
    assert odometry.rate_hz == pytest.approx(20.0)
    assert odometry.longest_gap_s == pytest.approx(0.05)


def test_a_gap_is_seen(tmp_path):
    with LogWriter(tmp_path / "run.mcap") as log:
        signals = SignalWriter(log, (), ())
        for second in (0, 1, 2, 7, 8):
            signals.write(topics.WRENCH_COMMAND, Wrench(second * NANOSECONDS, np.zeros(6)))
    (row,) = topic_rows(RunLog.open(tmp_path / "run.mcap"))
    assert row.longest_gap_s == 5.0
    assert row.rate_hz == 0.5


@pytest.mark.parametrize("name", ["disturbance/budget", "/auv/disturbance/budget"])
def test_values_are_those_that_were_written(path, name):
    rows = {row.field: row for row in value_rows(RunLog.open(path), name)}
    for axis, value in zip("xyz", RESTORING[3:], strict=True):
        row = rows[f"restoring.torque.{axis}"]
        assert (row.least, row.mean, row.most, row.last) == (value,) * 4
    assert rows["coupling.force.y"].mean == COUPLING[1]


def test_least_mean_and_most_are_those_of_the_motion(path):
    rows = {row.field: row for row in value_rows(RunLog.open(path), "joint_states")}
    times = np.arange(121) * 0.05
    last = ARM[3] + 0.5 * np.sin(0.2 * times)
    row = rows["position[3]"]
    assert row.least == pytest.approx(last.min())
    assert row.mean == pytest.approx(last.mean())
    assert row.most == pytest.approx(last.max())
    assert row.last == pytest.approx(last[-1])


def test_info_prints_run_vehicle_and_topics(path, capsys):
    assert main(["info", str(path)]) == 0
    text = capsys.readouterr().out
    assert "reference_auv" in text
    assert "0 s to 6" in text
    assert "battery          100.00% to 99.41%, at the end 48 V" in text
    assert "/auv/odometry" in text
    assert main(["info", "--json", str(path)]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["messages"] == sum(row["messages"] for row in facts["topics"])


def test_a_broken_log_is_shown_with_its_fault(path, tmp_path, capsys):
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(path.read_bytes()[:-2000])
    assert main(["info", str(cut)]) == 0
    assert "FAULT" in capsys.readouterr().out


def test_the_system_is_listed_without_a_log(capsys):
    assert main(["topics"]) == 0
    lines = {line.split()[0]: line for line in capsys.readouterr().out.splitlines()}
    assert {topic.name for topic in topics.ALL} <= set(lines)
    assert lines["odometry"].index("navigation") < lines["odometry"].index("controller")


@pytest.mark.parametrize("words", [[], ["odometri"]])
def test_a_missing_topic_names_those_there_are(path, words, capsys):
    assert main(["topics", str(path), *words]) == 2
    assert "/auv/odometry" in capsys.readouterr().err
