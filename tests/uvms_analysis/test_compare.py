"""Comparing two logs, and what a node got and gave in one."""

import numpy as np
import pytest
from synthetic import Known, write_log

from uvms_analysis.errors import LogError
from uvms_analysis.log.compare import compare, table
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_bringup.ros.replay import Metronome
from uvms_bringup.ros.schedule import TickOf, schedule
from uvms_core import topics
from uvms_core.signals import DisturbanceBudget, GpsSample, Wrench

PERIOD, STEP = 50_000_000, 500_000_000


@pytest.fixture(scope="module")
def logs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("logs")
    write_log(folder / "a.mcap", Known(duration=2.0))
    write_log(folder / "b.mcap", Known(duration=1.0, navigation=0.031))
    return RunLog.open(folder / "a.mcap"), RunLog.open(folder / "b.mcap")


def test_a_log_is_no_distance_from_itself(logs):
    items = [topics.ODOMETRY, topics.REFERENCE, topics.ALLOCATION, topics.CLOCK]
    for difference in compare(logs[0], logs[0], items):
        assert difference.recorded == difference.replayed == difference.common > 0
        assert difference.greatest == 0.0


def test_the_greatest_difference_is_found(logs):
    (difference,) = compare(*logs, [topics.ODOMETRY])
    counts = difference.recorded, difference.replayed, difference.common
    assert counts == (41, 21, 21)
    assert difference.greatest == pytest.approx(0.001, abs=1e-12)


def test_what_cannot_be_compared_is_nan(logs):
    (difference,) = compare(*logs, [topics.IMU])
    assert (difference.recorded, difference.replayed) == (0, 0)
    assert np.isnan(difference.greatest)
    assert "sensors/imu" in table([difference])


def test_two_unknown_positions_are_alike(tmp_path):
    nan = float("nan")
    for name in "ab":
        with LogWriter(tmp_path / f"{name}.mcap") as log:
            sample = GpsSample(0, False, nan, nan, nan, np.eye(3))
            SignalWriter(log, (), ()).write(topics.GPS, sample)
    one, two = (RunLog.open(tmp_path / f"{name}.mcap") for name in "ab")
    assert compare(one, two, [topics.GPS])[0].greatest == 0.0


def test_the_controller_gets_all_inputs_of_a_tick(logs):
    ticks = schedule(logs[0], "controller", TickOf(logs[0], PERIOD, STEP))
    assert [tick.stamp for tick in ticks] == [k * PERIOD for k in range(41)]
    for number, tick in enumerate(ticks):
        names = {"/clock", "/odometry", "/joint_states", "/disturbance", "/disturbance/budget"}
        names |= {"/allocation"} | ({"/reference"} if number % 10 == 0 else set())
        assert {name for name, _ in tick.inputs} == names
        assert tick.outputs == {"/wrench_command": 1, "/joint_command": 1, "/control/stability": 1}


def test_references_belong_to_the_tick_one_step_before(logs):
    ticks = schedule(logs[0], "motion_planner", TickOf(logs[0], PERIOD, STEP))
    assert [tick.stamp for tick in ticks] == [0, STEP, 2 * STEP, 3 * STEP]
    assert ticks[0].outputs == {"/reference": 2}
    assert sum(name == "/odometry" for name, _ in ticks[1].inputs) == 10


@pytest.mark.parametrize(
    ("name", "stamp", "tick"),
    [
        ("/sensors/imu", 10_000_000, PERIOD),
        ("/sensors/imu", PERIOD, PERIOD),
        ("/sensors/dvl", 125_000_000, 3 * PERIOD),
        ("/reference", 0, 0),
        ("/reference", 2 * STEP, STEP),
    ],
)
def test_outputs_belong_to_ticks(logs, name, stamp, tick):
    assert TickOf(logs[0], PERIOD, STEP)(name, stamp) == tick


def test_lacking_inputs_are_named(logs):
    with pytest.raises(LogError, match="lacks inputs of navigation: /sensors/imu, /sensors/dvl"):
        schedule(logs[0], "navigation", TickOf(logs[0], PERIOD, STEP))


def test_lacking_outputs_are_named(tmp_path):
    with LogWriter(tmp_path / "a.mcap") as log:
        signals = SignalWriter(log, (), ())
        signals.write(topics.CLOCK, 0)
        signals.write(topics.WRENCH_COMMAND, Wrench(0, np.zeros(6)))
        none = np.zeros(6)
        signals.write(topics.DISTURBANCE_BUDGET, DisturbanceBudget(0, none, none, none))
    run = RunLog.open(tmp_path / "a.mcap")
    with pytest.raises(LogError, match=r"has no output of thrust_allocator \(/thruster_command"):
        schedule(run, "thrust_allocator", TickOf(run, PERIOD, STEP))


@pytest.mark.parametrize(("rate", "ahead"), [(1.0, 1.5), (2.0, 0.5), (0.0, 0.0)])
def test_time_passes_at_the_rate(rate, ahead):
    now = [100.0]
    metronome = Metronome(rate, lambda: now[0])
    assert metronome.ahead(5_000_000_000) == 0.0
    now[0] += 0.5
    assert metronome.ahead(7_000_000_000) == pytest.approx(ahead)
