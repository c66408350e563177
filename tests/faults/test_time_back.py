"""Time that goes back or ahead: a plant that starts anew, a bag that loops, a gap."""

from dataclasses import replace

import numpy as np
import pytest
from wire import NODES, wire

from uvms_core import diagnostics, topics
from uvms_core.cdr import codec, stamp_in
from uvms_core.messages import from_message
from uvms_core.signals import JointGoal
from uvms_core.vehicle import load_vehicle
from uvms_observer.navigation.begin.resume import carried, lost

LOOP = [role for role in NODES if role != topics.PLANT]
SENSORS = [f"sensors/{name}" for name in ("imu", "dvl", "pressure", "gps")]


def reports_of(w, role):
    return [said for said in w.heard[topics.DIAGNOSTICS.name] if said.name == role]


def warnings_of(w, role):
    return [s.message for s in reports_of(w, role) if s.level == diagnostics.WARN]


def test_a_plant_that_starts_anew_resets_the_graph(saw):
    with wire() as w:
        w.start()
        w.run(5.0)
        w.add(topics.PLANT)
        w.start()
        w.run(1.5)
        assert w.works()
        for role in LOOP:
            assert w.count(role, "resets") == 1, role
            assert any("time went back from 4." in text for text in warnings_of(w, role)) or any(
                "time went back from 5" in text for text in warnings_of(w, role)
            ), role
        error = w.heard[topics.ODOMETRY.name][-1].position - w.plant.truth().odometry.position
    assert float(np.linalg.norm(error)) < 0.05
    saw("plant restarted, time back to 0", "all five nodes reset, said so, and work within 2 s")


def test_in_lockstep_a_plant_that_starts_anew_is_answered(saw):
    """The allocator has one input and one message: only silence tells it that time went back."""
    import time

    with wire(pace="lockstep", duration_s=3.0) as w:
        w.start()
        assert w.plant.stamp == 3_000_000_000
        w.add(topics.PLANT, pace="lockstep", duration_s=2.0)
        w.start()
        end = time.monotonic() + 2.0
        while w.plant.stamp < 2_000_000_000 and time.monotonic() < end:
            time.sleep(0.05)
            for role in LOOP:
                w.nodes[role].on_wake()
        assert w.plant.stamp == 2_000_000_000
    saw("plant restarted in lockstep", "answered after half a second")


def recorded(seconds):
    """What the sensors of a run sent: topic and bytes, in order."""
    with wire() as w:
        tape = []
        w.change = lambda name, data: (tape.append((name, data)), data)[1]
        w.start()
        w.run(seconds)
    return [(name, data) for name, data in tape if name in SENSORS]


@pytest.mark.parametrize("begin", [0.0, 5.0], ids=["to 0", "by 3 s"])
def test_a_bag_that_loops(begin, saw):
    tape = recorded(8.0)
    with wire(topics.NAVIGATION) as w:
        for name, data in tape:
            w.inject(name, data)
        before = len(w.heard[topics.ODOMETRY.name])
        again = [each for each in tape if stamp_in(each[1]) >= begin * 1e9]
        for name, data in again:
            w.inject(name, data)
        heard = [o for o in w.heard[topics.ODOMETRY.name][before:] if o.stamp >= begin * 1e9]
        assert w.count(topics.NAVIGATION, "resets") == 1
        node = w.nodes[topics.NAVIGATION]
        known = node.part.trouble() is None
        assert warnings_of(w, topics.NAVIGATION)
    assert len(heard) >= (8.0 - begin) / 0.05 - 2
    assert known == (begin == 0.0)  # in the middle of a run it does not know where it is
    saw(f"bag jumps back {'to its start' if known else 'by 3 s'}", "navigation resets and goes on")


def test_a_gap_is_taken_and_the_estimate_goes_on(saw):
    """Three seconds of sensors are lost: the filter goes on from its last estimate."""
    with wire() as w:
        w.start()
        w.run(3.0)
        w.cut = set(SENSORS)
        w.run(3.0)
        w.cut = set()
        w.run(1.5)
        assert w.works()
        assert w.count(topics.NAVIGATION, "resets") == 1
        estimate = w.heard[topics.ODOMETRY.name][-1]
        error = estimate.position - w.plant.truth().odometry.position
        std = np.sqrt(estimate.pose_covariance.diagonal()[:3])
    assert (np.abs(error) < 4.0 * std + 0.05).all()
    assert std[0] > 0.1
    saw(
        "no sensor for 3 s",
        f"reset, goes on; {np.linalg.norm(error):.2f} m off, std {std[0]:.2f} m",
    )


def test_a_goal_in_progress_is_aborted_with_the_reason():
    n = load_vehicle().n_joints
    with wire() as w:
        w.start()
        w.run(2.0)
        part = w.nodes[topics.MOTION_PLANNER].part
        now = w.heard[topics.JOINT_STATES.name][-1].position
        part.planner.accept(JointGoal(np.array([10.0]), (now - 0.2).reshape(1, n)))
        w.run(1.0)
        results = []
        step = part.step

        def watched(tick):
            outputs = list(step(tick))
            results.extend([part.plan.finished] if part.plan.finished else [])
            return outputs

        part.step = watched
        w.add(topics.PLANT)
        w.start()
        w.run(1.5)
    (result,) = results
    assert not result.success
    assert "time went back" in result.message


@pytest.mark.parametrize("role", LOOP)
def test_a_node_that_is_started_again_works_again(role, tmp_path, saw):
    """In the middle of a run, with nothing but what comes by the wire (and its checkpoint)."""
    more = {"checkpoint_file": str(tmp_path / "estimate.json")} if role == "navigation" else {}
    with wire(run_id="a") as w:
        w.remove(role)
        w.add(role, run_id="a", **more)
        w.start()
        w.run(3.0)
        w.remove(role)
        w.run(2.0)
        w.add(role, run_id="a", **more)
        w.run(2.0)
        assert w.works(), {r: n._status for r, n in w.nodes.items()}
        estimate = w.heard[topics.ODOMETRY.name][-1].position
        error = float(np.linalg.norm(estimate - w.plant.truth().odometry.position))
        assert w.nodes[topics.NAVIGATION].part.trouble() is None
    assert error < 1.5
    saw(f"{role} killed for 2 s", f"works within 2 s; estimate {error:.2f} m off")


def test_navigation_without_an_estimate_says_error_until_a_fix(saw):
    with wire() as w:
        w.start()
        w.run(3.0)
        w.remove(topics.NAVIGATION)
        w.run(1.0)
        w.add(topics.NAVIGATION)
        w.run(1.5)
        node = w.nodes[topics.NAVIGATION]
        odometry = w.heard[topics.ODOMETRY.name][-1]
        said = reports_of(w, topics.NAVIGATION)[-1]
        assert said.level == diagnostics.ERROR
        assert "started in the middle of a run without an estimate" in said.message
        assert np.sqrt(odometry.pose_covariance[0, 0]) > 1e3
        fix = _fix(w)
        w.inject(topics.GPS.name, fix)
        w.run(1.5)
        assert node.part.trouble() is None
        assert reports_of(w, topics.NAVIGATION)[-1].level == diagnostics.OK
    saw("navigation killed, no checkpoint", "says ERROR, covariance of km, until a GPS fix")


def _fix(w):
    """A fix at the datum, as at the surface."""
    from uvms_core.messages import to_message

    environment = load_vehicle().environment
    topic = topics.GPS
    signal = from_message(topic, codec(topic.type).decode(w.last[topic.name]))
    fix = replace(
        signal,
        stamp=w.plant.stamp,
        fix=True,
        latitude_deg=environment.datum_latitude_deg,
        longitude_deg=environment.datum_longitude_deg,
        altitude=-10.0,
        covariance=np.eye(3),
    )
    return codec(topic.type).encode(to_message(topic, fix))


def test_a_checkpoint_of_another_run_or_broken_is_none(tmp_path):
    from uvms_observer.nodes.checkpoint import Checkpoint

    file = tmp_path / "estimate.json"
    estimate = carried(lost(5 * 10**9, np.array([1.0, 2.0, 3.0])), 6 * 10**9)
    Checkpoint(file, "a").write(estimate)
    back = Checkpoint(file, "a").read()
    np.testing.assert_array_equal(back.pose_covariance, estimate.pose_covariance)
    assert back.stamp == estimate.stamp
    assert Checkpoint(file, "b").read() is None
    text = file.read_text()
    for broken in ("", "[]", "null", text[:-20], text.replace("1.0", "NaN"), "[" * 100_000):
        file.write_text(broken)
        assert Checkpoint(file, "a").read() is None
    assert Checkpoint(tmp_path / "none", "a").read() is None
