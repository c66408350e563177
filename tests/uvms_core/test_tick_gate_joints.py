"""Ticks and joint states that come late or not at all, and ticks without odometry."""

from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvms_core.tick_gate import Covering, Delayed, Same, TickGate

DT = 50


@dataclass(frozen=True)
class Sample:
    stamp: int


def delaying_gate(lockstep: bool = True, in_loop: bool = True) -> TickGate:
    return TickGate({"odometry": Same(), "joints": Delayed()}, "odometry", lockstep, in_loop)


def test_without_a_word_of_the_plant_the_joints_of_the_tick_are_waited_for():
    gate = delaying_gate()
    gate.push("joints", 0, "j0")
    assert [tick["joints"] for tick in gate.push("odometry", 0, "o0")] == ["j0"]
    assert gate.push("odometry", DT, "o1") == []
    assert [tick["joints"] for tick in gate.push("joints", DT, "j1")] == ["j1"]


@given(st.data())
def test_late_joints_are_the_newest_that_have_come_in_whatever_order_that_is_heard(data):
    """Late by two ticks from the second on, and at the sixth all at once."""
    came = {0: [0], 1: [], 2: [], 3: [1], 4: [2], 5: [3, 4, 5], 6: [6]}
    expected = {0: 0, 1: 0, 2: 0, 3: 1, 4: 2, 5: 5, 6: 6}
    gate, newest = delaying_gate(), -1
    for k, samples in came.items():
        newest = max([newest, *samples])
        messages = ["odometry", *(["joints"] * len(samples)), *(["gaps"] * (samples != [k]))]
        released, rest = [], [DT * each for each in samples]
        for name in data.draw(st.permutations(messages)):
            if name == "gaps":
                released += gate.skip(k * DT, {"joints": newest * DT})
            elif name == "joints":
                when = rest.pop(0)
                released += gate.push("joints", when, Sample(when))
            else:
                released += gate.push("odometry", k * DT, None)
        (tick,) = released
        assert (tick.stamp, tick["joints"]) == (k * DT, Sample(expected[k] * DT))


def test_a_node_beside_the_loop_does_not_take_joints_that_came_after_its_tick():
    gate = delaying_gate(in_loop=False)
    gate.push("joints", 0, "j0")
    gate.push("odometry", 0, "o0")
    gate.push("joints", DT, "j1")  # came at the tick of 3 DT
    gate.skip(3 * DT, {"joints": DT})
    gate.push("odometry", 2 * DT, "o2")
    (tick,) = gate.skip(2 * DT, {"joints": 0})
    assert (tick.stamp, tick["joints"]) == (2 * DT, "j0")
    (tick,) = gate.push("odometry", 3 * DT, "o3")
    assert (tick.stamp, tick["joints"]) == (3 * DT, "j1")


def test_a_late_sample_that_cannot_be_used_is_not_waited_for():
    gate = delaying_gate()
    gate.push("joints", 0, "j0")
    gate.push("odometry", 0, "o0")
    gate.push("odometry", 2 * DT, "o2")
    assert gate.skip(2 * DT, {"joints": DT}) == []
    (tick,) = gate.excuse("joints", DT)
    assert (tick["joints"], tick.missing) == ("j0", ())
    gate.push("odometry", 3 * DT, "o3")
    (tick,) = gate.skip(3 * DT, {"joints": DT})
    assert tick["joints"] == "j0"


def test_a_node_that_starts_before_any_joints_says_that_it_lacks_them():
    gate = delaying_gate()
    gate.push("odometry", DT, "o1")
    (tick,) = gate.skip(DT, {"joints": -1})
    assert (tick["joints"], tick.missing) == (None, ("joints",))


def test_in_real_time_the_newest_joints_are_taken_whatever_the_plant_says():
    gate = delaying_gate(lockstep=False)
    gate.push("joints", 0, "j0")
    gate.skip(DT, {"joints": -1})
    assert [tick["joints"] for tick in gate.push("odometry", DT, "o1")] == ["j0"]


@pytest.mark.parametrize("first", ["joints", "gaps"])
def test_a_tick_without_odometry_waits_for_the_joints_of_its_stamp_and_for_nothing_else(first):
    """What is safe may depend on them; the reference will not come, as there is no odometry."""
    inputs = {"odometry": Same(), "joints": Delayed(), "reference": Covering()}
    gate = TickGate(inputs, "odometry", lockstep=True)
    told = {
        "joints": lambda: gate.push("joints", DT, "j1"),
        "gaps": lambda: gate.skip(DT, {"odometry": -1}),
    }
    assert told.pop(first)() == []
    ((tick,),) = (rest() for rest in told.values())
    assert (tick.stamp, tick["joints"], tick.missing) == (DT, "j1", ("odometry",))


def test_a_tick_without_odometry_and_joints_waits_for_nothing():
    gate = delaying_gate()
    assert gate.skip(DT, {"odometry": -1}) == []
    (tick,) = gate.skip(DT, {"joints": -1})
    assert tick["joints"] is None


def test_in_real_time_late_joints_keep_their_own_stamp():
    gate = delaying_gate(lockstep=False)
    gate.push("joints", 0, Sample(0))
    gate.skip(DT, {"joints": 0})
    (tick,) = gate.push("odometry", DT, Sample(DT))
    assert tick["joints"] == Sample(0)
