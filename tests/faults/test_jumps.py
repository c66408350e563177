"""One tick of a value within its absolute bounds: refused as a jump, or harmless."""

import pytest
from at_the_bounds import CASES, Harm, at_the_bound, pose

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario

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
    return truths, process


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
        _NOMINAL["truths"] = closed_loop()[0]
    change, done = one_tick(topic, field)
    truths, process = closed_loop(change)
    harm = Harm(truths, _NOMINAL["truths"])
    print(topic.name, field, "refused", process.refused, process.unsafe, harm)
    assert done
    assert harm.is_small, harm
