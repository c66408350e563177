"""Single messages that are wrong in stamp or value: they are left out, and nothing else is lost."""

import struct

import numpy as np
import pytest
from bad_messages import HOUR
from wire import wire

from uvms_core import diagnostics, topics
from uvms_core.cdr import codec, stamp_in
from uvms_core.messages import from_message, to_message
from uvms_core.vehicle import load_vehicle

VEHICLE = load_vehicle()
READERS = {
    topic: sorted(topics.readers(topic) - {topics.PLANT})
    for topic in sorted(
        {t for n in topics.NODES.values() for t in n.inputs}, key=lambda topic: topic.name
    )
    if topic not in (topics.CLOCK, topics.THRUSTER_COMMAND, topics.JOINT_COMMAND)
}
OFF_M = 0.05
"""How far one bad message may push the vehicle that holds its place, m."""


def stamped(data, stamp):
    changed = bytearray(data)
    struct.pack_into("<iI", changed, 4, *divmod(stamp, 10**9))
    return bytes(changed)


def altered(topic, data, names=VEHICLE.joint_names, **fields):
    """A message whose signal has other values in some fields."""
    from dataclasses import replace

    signal = from_message(topic, codec(topic.type).decode(data), names)
    return codec(topic.type).encode(to_message(topic, replace(signal, **fields), names))


@pytest.mark.parametrize("topic", READERS, ids=lambda topic: topic.name)
@pytest.mark.parametrize(
    "shift",
    [HOUR, pytest.param(-HOUR, marks=pytest.mark.long)],
    ids=["hour ahead", "hour back"],
)
def test_one_wrong_stamp_blocks_nobody(topic, shift, saw):
    with wire() as w:
        w.start()
        w.run(1.0)
        resets = {role: w.count(role, "resets") for role in READERS[topic]}
        w.inject(topic.name, stamped(w.last[topic.name], stamp_in(w.last[topic.name]) + shift))
        w.run(1.5)
        assert w.works()
        assert w.drift() < OFF_M
        for role in READERS[topic]:
            assert w.count(role, "ahead") + w.count(role, "back") == 1, role
            assert w.count(role, "resets") == resets[role] == 0
        fused = w.nodes[topics.NAVIGATION].part.status()
    if topic in (topics.DVL, topics.PRESSURE):
        name = topic.name.removeprefix("sensors/")
        rate = getattr(VEHICLE.sensors, name).rate_hz
        assert fused[f"{name}_accepted"] >= 3.0 * rate - 2
    saw(f"{topic.name} stamped {shift / HOUR:+.0f} h once", "refused and counted; no tick lost")


def test_every_message_twice_changes_nothing():
    tracks = []
    for times in (1, 2):
        with wire() as w:
            w.start()
            put = w.put

            def repeat(name, data, put=put, times=times):
                for _ in range(times):
                    put(name, data)

            w.put = repeat
            w.run(2.0)
            tracks.append([(o.stamp, *o.position) for o in w.heard[topics.ODOMETRY.name][::times]])
            duplicates = w.count(topics.NAVIGATION, "duplicates")
    assert duplicates > 200
    assert tracks[0] == tracks[1]


IMPOSSIBLE = [
    (topics.JOINT_STATES, {"velocity": np.array([0.0, 100.0, 0.0, 0.0])}),
    (topics.JOINT_STATES, {"position": np.array([0.0, 0.5, 1e30, 0.0])}),
    (topics.ODOMETRY, {"nu": np.full(6, 1e3)}),
    (topics.ODOMETRY, {"position": np.array([50.0, 0.0, 10.0])}),
    (topics.ODOMETRY, {"twist_covariance": np.full((6, 6), 1e30)}),
    (topics.DISTURBANCE, {"wrench": np.full(6, 1e30)}),
    (topics.WRENCH_ACHIEVED, {"wrench": np.full(6, 1e30)}),
    (topics.WRENCH_COMMAND, {"wrench": np.full(6, 1e30)}),
    (topics.IMU, {"angular_velocity": np.array([0.0, 100.0, 0.0])}),
    (topics.IMU, {"linear_acceleration": np.array([0.0, 1e30, 0.0])}),
    (topics.DVL, {"velocity": np.array([1e3, 0.0, 0.0])}),
    (topics.PRESSURE, {"pressure": 0.0}),
    (topics.PRESSURE, {"pressure": 1e30}),
]


@pytest.mark.parametrize("pace", [pytest.param("realtime", marks=pytest.mark.long), "lockstep"])
def test_one_impossible_sample_is_left_out_and_its_tick_goes_on(pace, saw):
    """In lockstep the loop would stand still if a refused sample blocked a tick."""
    worst = 0.0
    for topic, fields in IMPOSSIBLE:
        with wire(pace=pace, duration_s=2.5) if pace == "lockstep" else wire() as w:
            _change_one(w, topic, 1_000_000_000, fields)
            w.start()
            if pace == "realtime":
                w.run(2.5)
            assert w.plant.stamp == 2_500_000_000, (topic.name, fields)
            for role in READERS[topic]:
                assert w.count(role, "implausible") == 1, (role, fields)
            reports = w.heard[topics.DIAGNOSTICS.name]
            assert any(r.level == diagnostics.ERROR and topic.name in r.message for r in reports)
            worst = max(worst, w.drift())
    assert worst < OFF_M
    saw(
        f"one impossible sample, {pace}", f"refused; {1e3 * worst:.0f} mm off", str(len(IMPOSSIBLE))
    )


def _change_one(w, topic, at, fields):
    """Change the first message of a topic from a stamp on."""
    done = []

    def change(name, data):
        if name != topic.name or done or (stamp_in(data) or 0) < at:
            return data
        done.append(name)
        return altered(topic, data, **fields)

    w.change = change


def test_an_input_that_stays_impossible_ends_in_the_safe_state_and_is_said(saw):
    with wire() as w:
        w.start()
        w.run(1.0)
        w.change = lambda name, data: (
            altered(topics.ODOMETRY, data, nu=np.full(6, 1e3)) if name == "odometry" else data
        )
        w.run(0.4)  # the last good value stands in
        assert w.since(topics.WRENCH_COMMAND, w.plant.stamp - 60_000_000)[-1].wrench.any()
        w.run(1.0)
        assert not w.since(topics.WRENCH_COMMAND, w.plant.stamp - 110_000_000)[-1].wrench.any()
        said = w.nodes[topics.CONTROLLER]._status
        w.change = lambda name, data: data
        w.run(1.5)
        assert w.works()
    assert said.level == diagnostics.ERROR
    assert "odometry" in said.message
    saw("odometry of nu = 1e3 for 1.4 s", "held 0.5 s, then no wrench; said; works again")


def test_a_jump_that_stays_is_taken_and_said(saw):
    """As a GPS fix at the surface moves the estimate: refusing it for ever would blind the node."""
    shift = np.array([0.0, 4.0, 0.0])
    with wire() as w:
        w.start()
        w.run(1.0)

        def moved(name, data):
            if name != topics.ODOMETRY.name:
                return data
            signal = from_message(topics.ODOMETRY, codec(topics.ODOMETRY.type).decode(data))
            return altered(topics.ODOMETRY, data, position=signal.position + shift)

        w.change = moved
        w.run(1.0)
        counts = w.nodes[topics.CONTROLLER]._intake.counts
        said = [s.message for s in w.heard[topics.DIAGNOSTICS.name] if s.name == "controller"]
    assert (counts["implausible"], counts["jumps_taken"]) == (4, 1)
    assert any("taken as real" in text for text in said)
    saw("odometry jumps by 4 m and stays", "four samples refused, then taken and said")


@pytest.mark.parametrize("missing", [topics.ODOMETRY, topics.JOINT_STATES], ids=lambda t: t.name)
def test_a_silent_node_says_what_it_waits_for(missing):
    """As where a topic is remapped in a graph that was started by hand."""
    import time

    with wire(topics.PLANT, topics.NAVIGATION, topics.CONTROLLER, run_id="r7") as w:
        w.cut = {missing.name}
        w.start()
        w.run(1.0)
        node, began = w.nodes[topics.CONTROLLER], len(w.heard[topics.DIAGNOSTICS.name])
        end = time.monotonic() + 2.2
        while time.monotonic() < end:
            time.sleep(max(0.0, min(node.deadline(), end) - time.monotonic()))
            node.on_wake()
        said = [s for s in w.heard[topics.DIAGNOSTICS.name][began:] if s.name == "controller"]
    assert len(said) >= 2
    assert f"waiting for /{missing.name} (nothing yet" in said[-1].message
    assert said[-1].run_id == "r7"
