"""A log is complete, or says that it is not."""

import os
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
    os.kill(run.process.pid, signal.SIGSTOP)
    time.sleep(seconds)
    os.kill(run.process.pid, signal.SIGCONT)


def test_the_plant_waits_for_a_recorder_that_lags_behind(tmp_path, saw):
    with running(tmp_path / "a", *GRAPH, "30") as run:
        run.await_ticks(100_000)
        halt(run, SHORT_HALT_S)
        assert run.code() == 0, run.text
    counted = messages(run)
    assert counted["/sensors/imu"] == 3001
    assert counted["/tf"] == counted["/clock"] == counted["/allocation"] == 601
    assert run.end.lost == {}
    assert {topic: n for topic, n in run.end.sent.items() if n}.items() <= counted.items()
    saw("recorder halted in lockstep", "the plant waits; 3,001 of 3,001 IMU messages, none lost")


@pytest.mark.long
def test_messages_lost_in_real_time_are_counted_by_topic(tmp_path, saw):
    with running(tmp_path / "a", *GRAPH, "60", "--pace", "realtime:10") as run:
        run.await_ticks(100_000)
        halt(run, SHORT_HALT_S)
        assert run.code() == 3, run.text
    counted, end = messages(run), run.end
    for name, lost in end.lost.items():
        assert end.sent[name] == counted[name] + lost
    assert end.lost or "the plant" in end.stopped_by  # it may be cut off, and then cannot count
    assert run.summary["completed"] is False
    assert any("messages" in reason for reason in run.summary["reasons"])
    stamps = [stamp for name, stamp, _ in run.log.raw() if name == "/rosout"]
    assert stamps  # nodes complained
    assert max(stamps) <= 60_000_000_000  # simulation time
    saw("recorder halted in real time", "the lost messages are counted; invalid, exit 3")


@pytest.mark.long
def test_a_recorder_that_the_graph_has_forgotten_says_what_is_missing(tmp_path, saw):
    with running(tmp_path / "a", *GRAPH, "60") as run:
        run.await_ticks(100_000)
        halt(run, LONG_HALT_S)
        assert run.code() == 3, run.text
    assert any("never came" in text for text in run.end.incidents)
    assert run.end.lost
    saw("recorder halted for 25 s in lockstep", "goes on, says what never came; invalid")


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
