"""Parts whose output is invalid: nothing of it gets out, in process and on the wire of a graph."""

import numpy as np
import pytest
from wire import wire

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_control.controller import Controller
from uvms_core import diagnostics, topics
from uvms_core.signals import JointCommand, Wrench
from uvms_observer.disturbance import DisturbanceObserver
from uvms_observer.navigation import NavigationFilter

AT = 2_000_000_000


class Poisoned(Controller):
    """A user's law whose state turns to NaN at some time, for good."""

    poison = 0.0

    def step(self, odometry, joints, disturbance, reference):
        wrench, command = super().step(odometry, joints, disturbance, reference)
        if odometry.stamp == AT:
            self.poison = np.nan
        return Wrench(wrench.stamp, wrench.wrench + self.poison), command


class AlwaysNaN(Controller):
    """A user's law that never makes a number."""

    def step(self, odometry, joints, disturbance, reference):
        wrench, command = super().step(odometry, joints, disturbance, reference)
        return wrench, JointCommand(command.stamp, command.effort * np.nan)


class Blind(NavigationFilter):
    """A filter whose estimate is NaN at one tick."""

    def step_screened(self, stamp, samples):
        odometry, faults = super().step_screened(stamp, samples)
        if stamp == AT:
            odometry.position[0] = np.nan
        return odometry, faults


class Mad(DisturbanceObserver):
    """An observer that makes 1e30 N at one tick."""

    def step(self, odometry, joints, achieved):
        budget, total = super().step(odometry, joints, achieved)
        return budget, Wrench(total.stamp, total.wrench * (1e30 if total.stamp == AT else 1.0))


PARTS = {
    "control.law": (Poisoned, topics.CONTROLLER),
    "navigation.filter": (Blind, topics.NAVIGATION),
    "observer.law": (Mad, topics.DISTURBANCE_OBSERVER),
}


@pytest.mark.parametrize("setting", PARTS)
def test_invalid_output_of_one_tick_stays_inside_in_process(setting):
    cls, role = PARTS[setting]
    loop = _loop(setting, cls)
    said = []
    for _ in range(80):
        tick = loop.tick()
        for topic, signal in tick.outputs:
            if topic is topics.DIAGNOSTICS and signal.level == diagnostics.ERROR:
                said.append(signal)
        for topic in (topics.WRENCH_COMMAND, topics.THRUSTER_COMMAND, topics.ODOMETRY):
            values = vars(tick.newest(topic)).values()
            assert all(np.isfinite(value).all() for value in values), topic.name
        loop.advance(tick)
    (status,) = said
    assert (status.name, status.level) == (role, diagnostics.ERROR)
    assert "output is not finite or beyond its bounds; restarted" in status.message
    assert np.linalg.norm(tick.truth.odometry.position - [0.0, 0.0, 10.0]) < 0.1


def test_a_law_that_never_makes_a_number_leaves_the_vehicle_limp_and_the_arm_held():
    loop = _loop("control.law", AlwaysNaN)
    before = loop.tick().truth.joints.position.copy()
    loop = _loop("control.law", AlwaysNaN)
    for _ in range(40):
        tick = loop.tick()
        assert not tick.wrench.wrench.any()
        assert np.isfinite(tick.joint_command.effort).all()
        loop.advance(tick)
    assert np.abs(tick.truth.joints.position - before).max() < np.radians(1.0)
    assert loop._process.unsafe == 40


def test_no_warning_of_overflow_reaches_the_terminal(recwarn):
    loop = _loop("observer.law", Mad)
    for _ in range(60):
        loop.advance(loop.tick())
    assert not [w for w in recwarn if issubclass(w.category, RuntimeWarning)]


@pytest.mark.parametrize("setting", PARTS)
def test_invalid_output_of_one_tick_stays_inside_a_node(setting):
    cls, role = PARTS[setting]
    name = setting.split(".")[1]
    with wire(topics.PLANT, *[r for r in topics.NODES if r not in (topics.PLANT, role)]) as w:
        node = w.add(role, **{name: f"{cls.__module__}:{cls.__name__}"})
        w.start()
        w.run(4.0)  # the wire fails where an output is not finite
        assert node.unsafe_outputs == 1
        assert w.works()
        assert w.drift() < 0.1
        said = [s for s in w.heard[topics.DIAGNOSTICS.name] if s.name == role]
    assert any(s.level == diagnostics.ERROR and "not finite or beyond" in s.message for s in said)


def _loop(setting, cls):
    scenario = load_scenario("hover", [f"{setting}={cls.__module__}:{cls.__name__}"])
    return Loop(scenario, scenario.load_vehicle())
