"""The gate releases the same ticks with the same inputs, whatever the order of arrival."""

import itertools
from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvms_core.tick_gate import Covering, Periodic, Previous, Same, TickGate

DT = 50


@dataclass(frozen=True)
class Window:
    end: int


def gate(lockstep: bool = True) -> TickGate:
    inputs = {
        "odometry": Same(),
        "joints": Same(),
        "fast": Periodic(10),
        "slow": Periodic(125),
        "feedback": Previous(DT),
    }
    return TickGate(inputs, "odometry", lockstep)


def tick_inputs(stamp: int) -> list[tuple[str, int]]:
    window = range(max(stamp - DT + 1, 0), stamp + 1)
    fast = [("fast", t) for t in window if t % 10 == 0]
    slow = [("slow", t) for t in window if t % 125 == 0]
    return [("odometry", stamp), ("joints", stamp), *fast, *slow]


@given(st.data())
def test_ticks_do_not_depend_on_the_order_of_arrival(data):
    gated = gate()
    for stamp in range(0, 5 * DT, DT):
        arrivals = tick_inputs(stamp)
        per_topic = {name: [t for n, t in arrivals if n == name] for name, _ in arrivals}
        order = data.draw(st.permutations([name for name, _ in arrivals]))
        released = []
        for name in order:  # the order within one topic is kept, as by DDS
            when = per_topic[name].pop(0)
            released.append(gated.push(name, when, (name, when)))
        assert not any(released[:-1])
        (tick,) = released[-1]
        assert tick.stamp == stamp
        expected = tuple(item for item in arrivals if item[0] == "fast")
        assert tick["fast"] == expected
        assert tick["slow"] == tuple(item for item in arrivals if item[0] == "slow")
        assert tick["feedback"] == (("feedback", stamp - DT) if stamp else None)
        gated.push("feedback", stamp, ("feedback", stamp))


def test_every_input_is_waited_for():
    for missing in ("odometry", "joints", "fast", "slow"):
        gated = gate()
        pushed = [item for item in tick_inputs(0) if item[0] != missing]
        assert not any(gated.push(name, when, None) for name, when in pushed)
        (tick,) = gated.push(missing, 0, None)
        assert tick.stamp == 0


def test_feedback_of_the_tick_before_is_waited_for():
    gated = gate()
    for name, when in itertools.chain(tick_inputs(0), tick_inputs(DT)):
        ticks = gated.push(name, when, (name, when))
    assert ticks == []
    assert gated.push("feedback", 0, "thrust")[0].stamp == DT


def test_a_loop_that_the_plant_broke_by_time_out_closes_again():
    gated = gate()
    for stamp in (0, DT, 2 * DT):  # feedback never comes: the plant goes on by time-out
        for name, when in tick_inputs(stamp):
            ticks = gated.push(name, when, (name, when))
    (tick,) = ticks
    assert tick.stamp == 2 * DT
    assert tick["feedback"] is None
    assert gated.abandoned == 1


def test_real_time_goes_by_the_trigger_with_the_newest_inputs():
    gated = gate(lockstep=False)
    gated.push("fast", 0, "f0")
    gated.push("joints", 0, "j0")
    (tick,) = gated.push("odometry", 0, "o0")
    assert (tick["joints"], tick["fast"], tick["slow"]) == ("j0", ("f0",), ())
    assert gated.push("odometry", DT, "o1")[0]["joints"] == "j0"


def test_real_time_waits_for_an_input_that_never_came():
    gated = gate(lockstep=False)
    assert gated.push("odometry", 0, "o0") == []
    assert [tick.stamp for tick in gated.push("joints", 0, "j0")] == [0]


def test_repeated_and_older_triggers_are_refused_and_counted():
    gated = gate(lockstep=False)
    gated.push("joints", 0, "j0")
    assert len(gated.push("odometry", DT, "a")) == 1
    assert gated.push("odometry", DT, "b") == []
    assert gated.push("odometry", 0, "c") == []
    assert gated.late == 2


def test_a_reference_covers_its_half_open_window():
    gated = TickGate({"tick": Same(), "reference": Covering()}, "tick", lockstep=True)
    assert gated.push("tick", 0, None) == []
    assert gated.push("reference", 0, Window(100))[0]["reference"] == Window(100)
    gated.push("reference", 100, Window(200))
    assert gated.push("tick", 50, None)[0]["reference"] == Window(100)
    assert gated.push("tick", 100, None)[0]["reference"] == Window(200)
    assert gated.push("tick", 200, None) == []


def test_a_node_beside_the_loop_keeps_its_open_ticks_in_order():
    gated = TickGate({"a": Same(), "b": Same()}, "a", lockstep=True, in_loop=False)
    assert gated.push("a", 0, "a0") == gated.push("a", DT, "a1") == []
    assert [tick.stamp for tick in gated.push("b", 0, "b0")] == [0]
    assert [tick.stamp for tick in gated.push("b", DT, "b1")] == [DT]
    assert gated.abandoned == 0


def test_a_trigger_faster_than_the_ticks():
    gated = TickGate({"imu": Periodic(10)}, "imu", lockstep=True, every=DT)
    released = [gated.push("imu", when, when) for when in range(0, 2 * DT + 1, 10)]
    ticks = [tick for some in released for tick in some]
    assert [tick.stamp for tick in ticks] == [0, DT, 2 * DT]
    assert ticks[1]["imu"] == (10, 20, 30, 40, 50)


@dataclass(frozen=True)
class Sample:
    stamp: int
    value: str = ""


def test_samples_out_of_order_are_put_in_their_place_and_repeated_ones_dropped():
    gated = TickGate({"imu": Periodic(10)}, "imu", lockstep=True, every=DT)
    gated.push("imu", 0, 0)
    for when in (20, 10, 10, 40, 30):
        gated.push("imu", when, when)
    (tick,) = gated.push("imu", DT, DT)
    assert tick["imu"] == (10, 20, 30, 40, 50)
    assert gated.duplicates == 1


def test_an_excused_input_is_held_as_of_the_tick_until_it_is_too_old():
    second = 1_000_000_000
    step = second // 20
    gated = TickGate({"a": Same(), "b": Same()}, "a", lockstep=True)
    gated.push("a", 0, Sample(0, "good"))
    gated.push("b", 0, Sample(0))
    for k in range(1, 15):
        assert gated.push("b", k * step, Sample(k * step)) == []
        (tick,) = gated.excuse("a", k * step)
        if k * step <= second // 2:
            assert tick["a"] == Sample(k * step, "good")
            assert tick.missing == ()
        else:
            assert tick.missing == ("a",)


def test_a_good_trigger_behind_a_refused_one_of_the_same_stamp_is_kept_for_the_next():
    gated = TickGate({"a": Same()}, "a", lockstep=False)
    gated.push("a", 0, Sample(0, "first"))
    gated.excuse("a", DT)
    assert gated.push("a", DT, Sample(DT, "second")) == []
    (tick,) = gated.excuse("a", 2 * DT)
    assert tick["a"] == Sample(2 * DT, "second")


def test_a_node_that_starts_late_does_not_wait_for_what_it_missed():
    gated = TickGate({"imu": Periodic(10), "slow": Periodic(1000)}, "imu", True, every=DT)
    (tick,) = gated.push("imu", 301 * DT, "i")
    assert tick.stamp == 301 * DT


def test_after_a_reset_time_may_start_over():
    gated = gate()
    for name, when in tick_inputs(0):
        gated.push(name, when, None)
    gated.reset()
    released = [gated.push(name, when, None) for name, when in tick_inputs(0)]
    assert [len(each) for each in released] == [0, 0, 0, 1]


def test_the_gate_says_what_it_waits_for():
    gated = TickGate({"a": Same(), "b": Same()}, "a", lockstep=False)
    assert gated.waiting() == ["a"]
    gated.push("a", 0, None)
    gated.push("a", DT, Sample(DT))
    assert gated.waiting() == ["b"]


@given(st.permutations(["odometry", "reference"]))
def test_a_refused_reference_excuses_no_tick_of_the_next_one(order):
    """Whatever comes first, the reference or the trigger, the tick has the reference."""
    gated = TickGate({"odometry": Same(), "reference": Covering()}, "odometry", lockstep=True)
    gated.push("reference", 0, Window(10 * DT))
    for k in range(10):
        gated.push("odometry", k * DT, k)
    gated.excuse("reference", 10 * DT)  # would have covered ten ticks, as the one before it
    for k in range(10, 20):
        (tick,) = gated.push("odometry", k * DT, k)
        assert tick["reference"] == Window(10 * DT)
    good, released = Window(30 * DT), []
    for name in order:
        released += gated.push(name, 20 * DT, good if name == "reference" else 20)
    (tick,) = released
    assert tick["reference"] == good


def skipping_gate() -> TickGate:
    """Trigger and a second sensor every 50 ms, in lockstep."""
    inputs = {"imu": Periodic(50), "dvl": Periodic(50)}
    return TickGate(inputs, trigger="imu", lockstep=True, every=50)


def test_a_tick_does_not_wait_for_a_sample_that_is_said_to_be_missing():
    gate = skipping_gate()
    gate.push("dvl", 0, "d0")
    assert [tick.stamp for tick in gate.push("imu", 0, "i0")] == [0]
    assert gate.push("imu", 50, "i50") == []
    (tick,) = gate.skip(50, {"dvl": 0})
    assert (tick.stamp, tick["imu"], tick["dvl"]) == (50, ("i50",), ())
    assert gate.held == gate.late == 0  # nothing was wrong with the node's inputs


def test_it_waits_for_the_late_sample_that_is_said_to_have_come():
    gate = skipping_gate()
    gate.push("dvl", 0, "d0")
    gate.push("imu", 0, "i0")
    gate.push("imu", 50, "i50")
    gate.skip(50, {"dvl": 0})
    assert gate.push("imu", 100, "i100") == []
    assert gate.skip(100, {"dvl": 50}) == []
    (tick,) = gate.push("dvl", 50, "d50")
    assert (tick.stamp, tick["dvl"]) == (100, ("d50",))


def test_a_tick_begins_without_a_trigger_that_is_missing():
    gate = skipping_gate()
    gate.push("dvl", 0, "d0")
    gate.push("imu", 0, "i0")
    assert gate.push("dvl", 50, "d50") == []
    (tick,) = gate.skip(50, {"imu": 0})
    assert (tick.stamp, tick["imu"], tick["dvl"]) == (50, (), ("d50",))
    gate.skip(100, {"imu": 50, "dvl": 50})  # the trigger comes late
    (tick,) = gate.push("imu", 50, "i50")
    assert (tick.stamp, tick["imu"]) == (100, ("i50",))


@pytest.mark.parametrize(
    "order", [(0, 1, 2), (0, 2, 1), (1, 0, 2), (1, 2, 0), (2, 0, 1), (2, 1, 0)]
)
def test_the_order_in_which_messages_and_gaps_come_does_not_matter(order):
    gate = skipping_gate()
    gate.push("dvl", 0, "d0")
    gate.push("imu", 0, "i0")
    gate.skip(50, {"dvl": 0})
    gate.push("imu", 50, "i50")
    steps = (
        lambda: gate.push("imu", 100, "i100"),
        lambda: gate.push("dvl", 50, "d50"),
        lambda: gate.skip(100, {"dvl": 50}),
    )
    ticks = [tick for k in order for tick in steps[k]()]
    assert [(tick.stamp, tick["dvl"]) for tick in ticks] == [(100, ("d50",))]


def test_a_late_sample_of_a_sensor_that_cannot_be_used_is_not_waited_for():
    gate = skipping_gate()
    gate.push("dvl", 0, "d0")
    gate.push("imu", 0, "i0")
    gate.skip(50, {"dvl": 0})
    gate.push("imu", 50, "i50")
    gate.push("imu", 100, "i100")
    assert gate.skip(100, {"dvl": 50}) == []
    (tick,) = gate.excuse("dvl", 50)
    assert (tick.stamp, tick["dvl"]) == (100, ())


def off_grid(lockstep, stamps):
    """Ticks of a gate whose trigger has stamps of its own, and the samples of each."""
    gated = TickGate({"imu": Periodic(10)}, "imu", lockstep=lockstep, every=DT)
    ticks = [tick for stamp in stamps for tick in gated.push("imu", stamp, stamp)]
    return {tick.stamp: tick["imu"] for tick in ticks}


def test_in_real_time_a_trigger_need_not_hit_the_multiples():
    """The first one after a multiple begins that tick; what is later waits for the next one."""
    stamps = [k * 31 + 7 for k in range(40)]
    ticks = off_grid(False, stamps)
    begun = range(DT, stamps[-1], DT)
    assert list(ticks) == list(begun)
    for stamp in begun:
        assert ticks[stamp] == tuple(s for s in stamps if stamp - DT < s <= stamp)


def test_in_lockstep_only_multiples_are_ticks():
    assert off_grid(True, [k * 30 + 7 for k in range(40)]) == {}


@pytest.mark.parametrize("late", [False, True])
def test_a_tick_whose_input_nobody_knows_yet_is_a_safe_one_and_waits_for_nothing(late):
    """As the odometry before navigation is initialised, whatever comes before or after that."""
    gated = gate()
    others = [item for item in tick_inputs(0) if item[0] != "odometry"]
    if not late:
        assert not [tick for name, stamp in others for tick in gated.push(name, stamp, stamp)]
    (tick,) = gated.skip(0, {"odometry": -1})
    assert (tick.stamp, tick.missing) == (0, ("odometry",))
    if late:
        assert not [tick for name, stamp in others for tick in gated.push(name, stamp, stamp)]
    gated.push("feedback", 0, 0)
    ticks = [tick for name, stamp in tick_inputs(DT) for tick in gated.push(name, stamp, stamp)]
    assert [(tick.stamp, tick.missing) for tick in ticks] == [(DT, ())]
    assert ticks[0]["odometry"] == DT
