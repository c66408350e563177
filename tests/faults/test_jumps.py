"""One tick of a value within its absolute bounds: refused as a jump, or harmless."""

import pytest
from at_the_bounds import CASES, VEHICLE, Harm, at_the_bound, pose
from wire import wire

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics
from uvms_core.cdr import codec, stamp_in
from uvms_core.messages import from_message, to_message

AT = 1_000_000_000
TICKS = 60
IDS = [f"{topic.name}-{field}" for topic, field in CASES]
_NOMINAL: dict[str, list] = {}


def closed_loop(change=lambda topic, signal: signal):
    """True poses over three seconds in one process, with signals changed on their way."""
    scenario = load_scenario("hover")
    loop = Loop(scenario, scenario.load_vehicle())
    process, truths = loop._process, []
    admit_all = process.admit_all
    process.admit_all = lambda outputs: admit_all([(t, change(t, s)) for t, s in outputs])
    for part in loop.parts.values():
        step = part.step
        part.step = lambda tick, step=step: [(t, change(t, s)) for t, s in step(tick)]
    for _ in range(TICKS):
        tick = loop.tick()
        truths.append(pose(tick.truth.odometry, tick.truth.joints))
        loop.advance(tick)
    return truths


def one_tick(topic, field):
    """A change of the first signal of a topic from `AT` on."""
    done = []

    def change(each, signal):
        if each.name != topic.name or done or signal.stamp < AT:
            return signal
        done.append(signal.stamp)
        return at_the_bound(topic, signal, field)

    return change, done


@pytest.mark.parametrize(("topic", "field"), CASES, ids=IDS)
def test_one_tick_at_nine_tenths_of_a_bound_does_no_harm_in_process(topic, field):
    if not _NOMINAL:
        _NOMINAL["truths"] = closed_loop()
    change, done = one_tick(topic, field)
    truths = closed_loop(change)
    harm = Harm(truths, _NOMINAL["truths"])
    assert done
    assert harm.is_small, harm


EACH_S = 1.0
"""Simulated time for the effect of each case."""


def at_the_bound_on_the_wire(topic, data, field):
    """The same of a message's bytes."""
    by_thruster = topic is topics.THRUSTER_COMMAND
    names = VEHICLE.thruster_names if by_thruster else VEHICLE.joint_names
    signal = from_message(topic, codec(topic.type).decode(data), names)
    changed = at_the_bound(topic, signal, field)
    return codec(topic.type).encode(to_message(topic, changed, names))


def graph(change=None):
    """True poses in a graph of the real nodes, with messages changed on their way."""
    with wire() as w:
        if change is not None:
            w.change = change
        w.start()
        w.run(EACH_S * (len(CASES) + 1))
        odometry, joints = (
            w.heard[topics.TRUE_ODOMETRY.name],
            w.heard[topics.TRUE_JOINT_STATES.name],
        )
        truths = [pose(*each) for each in zip(odometry, joints, strict=True)]
        assert w.works()
        return truths


def test_one_tick_at_nine_tenths_of_each_bound_does_no_harm_in_the_graph(saw):
    """One case after the other, with what the graph does without any for comparison."""
    left = [(EACH_S * (i + 1), topic, field) for i, (topic, field) in enumerate(CASES)]
    done = []

    def change(name, data):
        stamp = stamp_in(data)
        if not left or name != left[0][1].name or stamp is None or stamp < 1e9 * left[0][0]:
            return data
        _, topic, field = left.pop(0)
        done.append((topic.name, field))
        return at_the_bound_on_the_wire(topic, data, field)

    truths, nominal = graph(change), graph()
    assert len(done) == len(CASES)
    ticks, worst = round(EACH_S / 0.05), {}
    for i, case in enumerate(done):
        window = slice(ticks * (i + 1), ticks * (i + 2))
        worst[case] = Harm(truths[window], nominal[window])
    assert all(harm.is_small for harm in worst.values()), worst
    off = max(harm.off_m for harm in worst.values())
    saw(
        "one tick at 0.9 of each bound",
        f"refused or harmless; {1e3 * off:.0f} mm off",
        str(len(CASES)),
    )
