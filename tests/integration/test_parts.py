"""Parts declare what the table of topics says of their role, and run in that order."""

from types import SimpleNamespace

import pytest

from uvms_bringup.loop import make_parts
from uvms_bringup.scenario import load_scenario
from uvms_core import topics
from uvms_core.errors import PluginError
from uvms_core.part import InProcess, Part, loop_order
from uvms_core.tick_gate import Previous, Same, Tick


@pytest.fixture(scope="module")
def parts():
    scenario = load_scenario("hover")
    return make_parts(scenario, scenario.load_vehicle())


def test_every_role_but_the_plant_has_a_part(parts):
    assert set(parts) == set(topics.NODES) - {"plant"}


def test_parts_read_and_write_what_the_table_of_topics_says(parts):
    for role, part in parts.items():
        own = topics.NODES[role]
        assert set(part.inputs) | {topics.CLOCK} == set(own.inputs), role
        assert tuple(part.outputs) == own.outputs, role
        assert part.trigger in part.inputs


def test_each_part_comes_after_those_that_write_its_inputs_of_the_tick(parts):
    order = loop_order(parts)
    writers = {topic: role for role, part in parts.items() for topic in part.outputs}
    for role, part in parts.items():
        for topic, rule in part.inputs.items():
            if topic in writers and not isinstance(rule, Previous):
                assert order.index(writers[topic]) < order.index(role)


class Relay(Part):
    """Hands a wrench on."""

    def __init__(self, source, target, rule):
        self.trigger, self.outputs, self.inputs = source, (target,), {source: rule}

    def step(self, tick: Tick):
        wrench = tick[self.trigger.name]
        yield self.outputs[0], SimpleNamespace(stamp=tick.stamp, value=wrench.value + 1)


def test_parts_that_wait_for_each_other_are_named():
    a, b = topics.WRENCH_COMMAND, topics.WRENCH_ACHIEVED
    ring = {"one": Relay(a, b, Same()), "two": Relay(b, a, Same())}
    with pytest.raises(PluginError, match=r"wait for each other within a tick: .*one.*"):
        loop_order(ring)


def test_signals_go_from_part_to_part_within_a_tick():
    a, b, c = topics.DISTURBANCE, topics.WRENCH_COMMAND, topics.WRENCH_ACHIEVED
    process = InProcess({"second": Relay(b, c, Same()), "first": Relay(a, b, Same())})
    process.deliver(a, SimpleNamespace(stamp=0, value=1))
    done = [(role, outputs[0][1].value) for role, outputs in process.tick(0)]
    assert done == [("first", 2), ("second", 3)]


class Absent(Relay):
    """Has a mistake."""

    def step(self, tick: Tick):
        wrench, torques = None
        return wrench, torques


def test_a_step_that_fails_is_named_with_its_place():
    a, b = topics.DISTURBANCE, topics.WRENCH_COMMAND
    process = InProcess({"controller": Absent(a, b, Same())})
    process.deliver(a, SimpleNamespace(stamp=50_000_000, value=1))
    reason = r"controller: its step failed at t = 0.05 s: TypeError: .*test_parts\.py:\d+"
    with pytest.raises(PluginError, match=reason):
        list(process.tick(50_000_000))
