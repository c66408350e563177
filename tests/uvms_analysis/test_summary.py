"""Summaries of a run whose metrics are known beforehand."""

import json

import numpy as np
import pytest
from synthetic import Known, write_log

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.recover import recover
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.summary import at_end, percentiles, rms_and_max, summarise

KNOWN = Known(duration=12.0, path_duration=10.0)


@pytest.fixture(scope="module")
def log_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "run.mcap"
    write_log(path, KNOWN)
    return path


@pytest.fixture(scope="module")
def summary(log_file):
    return summarise(log_file, wall_s=4.0)


def test_all_metrics_are_there(summary):
    assert {
        "scenario",
        "seed",
        "completed",
        "sim_duration_s",
        "wall_s",
        "real_time_factor",
        "lockstep_timeouts",
        "end_effector_error_m",
        "navigation_error_m",
        "roll_deg",
        "pitch_deg",
        "self_disturbance",
        "planner_step_ms",
        "least_manipulability",
        "thruster_saturated_fraction",
    } <= set(summary)
    assert json.loads(json.dumps(summary)) == summary


def test_references_without_a_disturbance_are_read_and_it_is_said(tmp_path):
    write_log(tmp_path / "run.mcap", Known(duration=3.0, plans_disturbance=False))
    found = summarise(tmp_path / "run.mcap", wall_s=None)
    assert found["planned_disturbance_error"] == {"force_rms_n": None, "moment_rms_nm": None}
    assert "do not say what disturbance" in found["missing"]["planned_disturbance_error"]
    assert found["vehicle_error_m"]["rms"] is not None


def test_run_and_time(summary):
    assert (summary["scenario"], summary["seed"]) == ("synthetic", 7)
    assert (summary["sim_duration_s"], summary["wall_s"]) == (12.0, 4.0)
    assert summary["real_time_factor"] == 3.0
    assert summary["lockstep_timeouts"] == 2


def test_end_effector_error_is_that_of_the_truth_while_the_path_runs(summary):
    # A sine of 20 mm over five whole periods; 201 samples, of which the last is at a zero.
    assert summary["end_effector_target"] == "path"
    assert summary["end_effector_error_m"]["max"] == pytest.approx(0.02, abs=1e-9)
    rms = 0.02 * np.sqrt(100 / 201)
    assert summary["end_effector_error_m"]["rms"] == pytest.approx(rms, abs=1e-9)


def test_errors_of_vehicle_and_estimate(summary):
    assert summary["navigation_error_m"]["rms"] == pytest.approx(0.03, abs=1e-12)
    assert summary["vehicle_error_m"]["max"] == pytest.approx(0.02, abs=1e-9)
    tracking = np.hypot(0.02, 0.03)
    assert summary["end_effector_tracking_error_m"]["max"] == pytest.approx(tracking, abs=1e-9)


def test_attitude(summary):
    assert summary["roll_deg"]["max"] == pytest.approx(2.0, abs=1e-9)
    assert summary["roll_deg"]["rms"] == pytest.approx(2.0 * np.sqrt(120 / 241), abs=1e-9)
    assert summary["pitch_deg"]["max"] == pytest.approx(1.5, abs=1e-9)


def test_forces_and_computing_time(summary):
    assert summary["self_disturbance"] == {"force_rms_n": 5.0, "moment_rms_nm": 5.0}
    assert summary["planned_disturbance_error"] == {"force_rms_n": 2.0, "moment_rms_nm": 1.0}
    assert summary["thruster_saturated_fraction"] == pytest.approx(61 / 241)
    assert summary["planner_step_ms"]["p50"] == 13.0
    assert summary["least_manipulability"] == pytest.approx(1 / 26)
    assert summary["planner_step_ms"]["p99"] == pytest.approx(24.76)


def test_stability_of_the_loop(summary):
    # V halves every half second from 4 on; 121 of 241 ticks have 2 W of supply for 1 W of demand.
    found = summary["stability"]
    assert found["condition_holds"] == pytest.approx(121 / 241)
    assert found["lyapunov_falls"] == 1.0
    assert found["lyapunov_max"] == 4.0
    assert found["lyapunov_end"] == pytest.approx(4.0 * 0.5**14)
    squares = 16.0 * (1.0 - 0.5 ** (241 / 5)) / (1.0 - 0.5**0.2)
    assert found["lyapunov_rms"] == pytest.approx(np.sqrt(squares / 241))


def test_a_log_without_stability_says_why_its_figures_are_missing(tmp_path):
    known = Known(duration=3.0, path_duration=2.0, with_stability=False)
    write_log(tmp_path / "run.mcap", known)
    summary = summarise(tmp_path / "run.mcap", wall_s=1.0)
    assert set(summary["stability"].values()) == {None}
    assert "has no control/stability" in summary["missing"]["stability"]


def test_the_start_of_the_path_is_found_where_the_planner_does_not_report_it(tmp_path, summary):
    write_log(tmp_path / "run.mcap", Known(duration=12.0, path_duration=10.0, name_start=False))
    other = summarise(tmp_path / "run.mcap", wall_s=4.0)
    assert other["end_effector_error_m"] == summary["end_effector_error_m"]


def test_without_a_path_the_plan_is_the_target(tmp_path):
    write_log(tmp_path / "run.mcap", Known(duration=12.0, path_duration=10.0, with_path=False))
    summary = summarise(tmp_path / "run.mcap", wall_s=1.0)
    assert summary["end_effector_target"] == "reference"
    assert summary["end_effector_error_m"]["max"] == pytest.approx(0.02, abs=1e-9)


def test_with_neither_the_start_is_held(tmp_path):
    known = Known(duration=4.0, path_duration=10.0, start=100.0, with_path=False)
    write_log(tmp_path / "run.mcap", known)
    summary = summarise(tmp_path / "run.mcap", wall_s=1.0)
    assert summary["end_effector_target"] == "start"
    assert summary["end_effector_error_m"]["max"] == pytest.approx(0.02, abs=1e-9)


def test_a_broken_off_log_is_summed_up_as_far_as_it_goes(tmp_path, log_file, summary):
    data = log_file.read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: int(0.6 * len(data))])
    part = summarise(tmp_path / "cut.mcap", wall_s=4.0)
    assert part["log_fault"].startswith("the writer was stopped")
    assert 1.0 < part["sim_duration_s"] < 12.0
    assert part["end_effector_error_m"]["max"] == pytest.approx(0.02, abs=1e-9)
    recover(tmp_path / "cut.mcap", tmp_path / "whole.mcap")
    whole = summarise(tmp_path / "whole.mcap", wall_s=4.0)
    changed = ("log_fault", "reasons", "check")
    figures = [{k: v for k, v in one.items() if k not in changed} for one in (part, whole)]
    assert figures[0] == figures[1]
    assert whole["log_fault"] is None


def test_an_empty_log_has_a_summary_of_nothing(tmp_path):
    LogWriter(tmp_path / "a.mcap").close()
    summary = summarise(tmp_path / "a.mcap", wall_s=0.0)
    assert summary["end_effector_error_m"] == {"rms": None, "max": None, "end": None}
    assert summary["real_time_factor"] is None
    assert summary["planner_step_ms"] == {"p50": None, "p99": None}
    assert summary["least_manipulability"] is None
    assert json.loads(json.dumps(summary)) == summary


def test_lacking_attachments_are_named(tmp_path):
    LogWriter(tmp_path / "a.mcap").close()
    with pytest.raises(LogError, match=r"has no attachment 'vehicle.yaml'; it has none"):
        _ = Analysis(RunLog.open(tmp_path / "a.mcap")).vehicle


def test_statistics():
    assert rms_and_max(np.array([3.0, -4.0])) == {"rms": np.sqrt(12.5), "max": 4.0}
    assert rms_and_max(np.array([[3.0, 4.0], [0.0, 0.0]])) == {"rms": np.sqrt(12.5), "max": 5.0}
    assert percentiles(np.arange(101.0)) == {"p50": 50.0, "p99": 99.0}


def test_the_end_of_a_run_is_its_last_five_seconds():
    times = np.linspace(0.0, 20.0, 401)
    settling = np.exp(-0.5 * times)
    assert at_end(settling, times) == {"end": pytest.approx(np.exp(-7.5))}
    vectors = np.zeros((401, 3))
    vectors[300] = [3.0, 0.0, 4.0]
    assert at_end(vectors, times) == {"end": 5.0}
    vectors[300], vectors[299] = 0.0, 1.0
    assert at_end(vectors, times) == {"end": 0.0}
    assert at_end(settling[:50], times) == {"end": 1.0}
    assert at_end(np.zeros((0, 3)), times) == {"end": None}
