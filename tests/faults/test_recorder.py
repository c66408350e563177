"""A log is complete, or says that it is not."""

import signal
import time
from collections import Counter

import pytest
from live import LiveRun, running

from uvms_bringup.ros.acknowledge import window_for
from uvms_core import topics
from uvms_core.vehicle import load_vehicle

GRAPH = ("run", "hover", "--duration")
SHORT_HALT_S, LONG_HALT_S = 4.0, 25.0
"""Within and beyond the time for which the middleware remembers a silent process (20 s)."""


def messages(run: LiveRun) -> Counter:
    return Counter(name for name, _, _ in run.log.raw())


def halt(run: LiveRun, seconds: float) -> None:
    run.signal(signal.SIGSTOP)
    time.sleep(seconds)
    run.signal(signal.SIGCONT)


def test_the_plant_waits_for_a_recorder_that_lags_behind(tmp_path, saw):
    with running(tmp_path / "a", *GRAPH, "60") as run:
        run.await_ticks(100_000)
        halt(run, SHORT_HALT_S)
        assert run.code() == 0, run.text
    counted = messages(run)
    assert counted["/sensors/imu"] == 6001
    assert counted["/tf"] == counted["/clock"] == counted["/allocation"] == 1201
    assert run.end.lost == {}
    sent = {name: number for name, number in run.end.sent.items() if name != "/diagnostics"}
    assert sent.items() <= counted.items()
    saw("recorder halted in lockstep", "the plant waits; 6,001 of 6,001 IMU messages, none lost")


def test_messages_lost_in_real_time_are_counted_by_topic(tmp_path, saw):
    with running(tmp_path / "a", *GRAPH, "240", "--pace", "realtime:20") as run:
        run.await_ticks(100_000)
        halt(run, SHORT_HALT_S)
        run.code()
    counted, end = messages(run), run.end
    assert end.lost["/sensors/imu"] > 1000
    assert end.sent["/sensors/imu"] == counted["/sensors/imu"] + end.lost["/sensors/imu"]
    assert run.summary["completed"] is False
    saw("recorder halted in real time", "the lost messages are counted; invalid")


@pytest.mark.long
def test_a_recorder_that_the_graph_has_forgotten_says_what_is_missing(tmp_path, saw):
    with running(tmp_path / "a", *GRAPH, "60") as run:
        run.await_ticks(100_000)
        halt(run, LONG_HALT_S)
        assert run.code() == 3, run.text
    assert any("never came" in text for text in run.end.incidents)
    assert run.end.lost
    saw("recorder halted for 25 s in lockstep", "goes on, says what never came; invalid")


def test_rosout_is_recorded_with_simulation_time(tmp_path):
    with running(tmp_path / "a", *GRAPH, "8", "--pace", "realtime:2") as run:
        process = run.await_node("thrust_allocator")
        run.await_ticks(40_000)
        _halt_process(process, 1.5)
        run.code()
    stamps = [stamp for name, stamp, _ in run.log.raw() if name == "/rosout"]
    assert stamps
    assert max(stamps) <= 8_000_000_000


def _halt_process(process: int, seconds: float) -> None:
    import os

    os.kill(process, signal.SIGSTOP)
    time.sleep(seconds)
    os.kill(process, signal.SIGCONT)


@pytest.mark.parametrize("rate", [100.0, 1000.0, 5000.0])
def test_the_window_keeps_every_topic_within_its_history(rate):
    vehicle = load_vehicle()
    imu = vehicle.sensors.mounted["imu"].model_copy(update={"rate_hz": rate})
    sensors = vehicle.sensors.model_copy(update={"imu": imu})
    fast = vehicle.model_copy(update={"sensors": sensors})
    period_s = 0.05
    window = window_for(fast, round(period_s * 1e9))
    assert window >= 1
    assert window * period_s * rate <= topics.IMU.qos.depth / 2
