"""What is believed of thrusters, what authority remains, what is told; all without ROS."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from uvms_control import AllocatorConfig
from uvms_control.errors import ControlSetupError
from uvms_control.health import ThrusterBelief, lost_axes, remaining_authority
from uvms_control.health.lasting import Lasting
from uvms_control.parts import AllocatorPart
from uvms_control.vehicle_data import thruster_limits
from uvms_core import topics
from uvms_core.diagnostics import ERROR, WARN
from uvms_core.errors import ConfigError, SignalError
from uvms_core.signals import DisturbanceBudget, ThrusterHealth, Wrench, to_nanoseconds
from uvms_core.tick_gate import Tick
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix

VEHICLES = ("reference_auv", "bluerov2_alpha5", "reference_auv_three_thrusters")
PERIOD = to_nanoseconds(0.05)
NAMES = ("port", "starboard", "heave")


def authority_by_solver(matrix, limits, shares):
    """The same linear programs, by HiGHS."""
    bounds = (limits * shares).T
    found = []
    for axis in range(6):
        others = np.delete(matrix, axis, axis=0)
        ends = [
            -linprog(-sign * matrix[axis], A_eq=others, b_eq=np.zeros(5), bounds=bounds).fun
            for sign in (1.0, -1.0)
        ]
        found.append(min(ends))
    return np.array(found)


@settings(max_examples=20, deadline=None)
@given(shares=st.lists(st.sampled_from([0.0, 0.3, 1.0]), min_size=7, max_size=7))
@pytest.mark.parametrize("name", VEHICLES)
def test_remaining_authority_is_the_optimum_of_the_linear_programs(name, shares):
    vehicle = load_vehicle(name)
    matrix, limits = thruster_matrix(vehicle), thruster_limits(vehicle)[0]
    own = np.array(shares[: matrix.shape[1]])
    expected = authority_by_solver(matrix, limits, own)
    assert remaining_authority(matrix, limits, own) == pytest.approx(expected, abs=1e-6)


def test_of_four_verticals_three_still_roll_with_half_the_moment():
    """The pair of the side that is whole: 2 x 49 N x 0.1 m; fore and aft cancel in the other."""
    vehicle = load_vehicle("reference_auv")
    matrix, limits = thruster_matrix(vehicle), thruster_limits(vehicle)[0]
    shares = np.ones(7)
    nominal = remaining_authority(matrix, limits, shares)
    shares[3] = 0.0
    remaining = remaining_authority(matrix, limits, shares)
    assert nominal[3] == pytest.approx(19.6)
    assert remaining[3] == pytest.approx(9.8)
    assert not lost_axes(remaining, nominal).any()


@pytest.mark.parametrize(("thruster", "axes"), [(0, [0]), (1, [1, 5])])
def test_axes_that_one_thruster_holds_are_lost_with_it(thruster, axes):
    vehicle = load_vehicle("reference_auv")
    matrix, limits = thruster_matrix(vehicle), thruster_limits(vehicle)[0]
    shares = np.ones(7)
    nominal = remaining_authority(matrix, limits, shares)
    shares[thruster] = 0.0
    lost = lost_axes(remaining_authority(matrix, limits, shares), nominal)
    assert np.flatnonzero(lost).tolist() == axes


def health(*left, sigma=0.01):
    return ThrusterHealth(np.array(left, dtype=float), np.full(len(left), sigma))


def test_the_users_word_comes_before_the_estimate():
    belief = ThrusterBelief(NAMES, {"heave": 0.5})
    belief.estimate(health(0.0, 1.0, 0.0))
    assert belief.effectiveness.tolist() == [0.0, 1.0, 0.5]
    belief.say({"port": 1.0})
    assert belief.effectiveness.tolist() == [1.0, 1.0, 0.5]
    belief.say({"port": np.nan, "heave": np.nan})
    assert belief.effectiveness.tolist() == [0.0, 1.0, 0.0]
    assert belief.source("port") == "estimated"


def test_an_uncertain_loss_is_a_suspicion_and_a_small_one_is_nothing():
    belief = ThrusterBelief(NAMES, {})
    belief.estimate(ThrusterHealth(np.array([0.2, 0.85, 1.0]), np.array([0.8, 0.01, 0.2])))
    assert belief.effectiveness.tolist() == [1.0, 1.0, 1.0]
    assert belief.suspected == ("port",)


def test_a_method_that_estimates_nothing_leaves_all_whole():
    belief = ThrusterBelief(NAMES, {})
    belief.estimate(None)
    assert belief.effectiveness.tolist() == [1.0, 1.0, 1.0]
    assert belief.suspected == ()


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ({"bow": 0.0}, ["'bow'", "port, starboard, heave"]),
        ({"port": 1.3}, ["1.3", "0 (dead) to 1.2"]),
        ({"port": -0.1}, ["-0.1", "0 (dead) to 1.2"]),
    ],
)
def test_a_wrong_word_is_refused_as_a_whole(said, words):
    belief = ThrusterBelief(NAMES, {})
    with pytest.raises(ControlSetupError) as fault:
        belief.say({"heave": 0.0} | said)
    assert all(word in str(fault.value) for word in words)
    assert belief.effectiveness.tolist() == [1.0, 1.0, 1.0]


def test_flags_count_once_they_have_lasted():
    lasting = Lasting(1.0)
    for tick, flag in enumerate([1, 1, 1, 0, 1, 1, 1, 1]):
        lasting.step(to_nanoseconds(0.5 * tick), np.array([flag, 1], dtype=bool))
    assert lasting.flags.tolist() == [True, True]
    lasting.step(to_nanoseconds(4.0), np.array([False, True]))
    assert lasting.flags.tolist() == [False, True]


class Allocator:
    """The part, called tick by tick."""

    def __init__(self, **config):
        self.part = AllocatorPart(load_vehicle("reference_auv"), AllocatorConfig(**config), PERIOD)
        self.stamp = 0

    def run(self, seconds, wrench, budget=None):
        """The last command and allocation after some time; every command of it."""
        commands = []
        for _ in range(round(seconds / 0.05)):
            values = {
                topics.WRENCH_COMMAND.name: Wrench(self.stamp, np.array(wrench, dtype=float)),
                topics.DISTURBANCE_BUDGET.name: budget,
            }
            outputs = dict(self.part.step(Tick(self.stamp, values, ())))
            commands.append(outputs[topics.THRUSTER_COMMAND].thrust)
            self.stamp += PERIOD
        return outputs[topics.ALLOCATION], np.array(commands)


def budget(left, external=(0.0,) * 6):
    none = np.zeros(6)
    return DisturbanceBudget(0, none, none, np.array(external), thrusters=health(*left))


def test_a_configured_dead_thruster_is_not_used_and_its_share_is_reported():
    allocator = Allocator(effectiveness={"vertical_fore_port": 0.0})
    allocation, commands = allocator.run(5.0, [0, 0, 20, 2, 0, 0])
    assert (commands[:, 3] == 0.0).all()
    assert allocation.effectiveness.tolist() == [1, 1, 1, 0, 1, 1, 1]
    assert allocation.achieved == pytest.approx([0, 0, 20, 2, 0, 0], abs=1e-6)
    assert allocator.part.trouble().level == WARN
    assert "vertical_fore_port gives 0%" in allocator.part.trouble().text


def test_an_unknown_configured_name_lists_the_choices():
    with pytest.raises((ControlSetupError, ConfigError), match="main, side_fore"):
        Allocator(effectiveness={"bow": 0.0})


def test_a_thruster_that_is_thought_dead_is_tested_now_and_then():
    allocator, left = Allocator(), [0, 1, 1, 1, 1, 1, 1]
    allocation, commands = allocator.run(8.0, np.zeros(6), budget(left))
    tested = commands[:, 0]
    assert tested.max() == pytest.approx(0.03 * 98.0)
    assert tested.sum() == pytest.approx(0.0)
    assert np.mean(tested != 0.0) < 0.35
    assert allocation.achieved == pytest.approx(np.zeros(6))


def test_a_lost_axis_is_an_error_and_a_push_along_it_asks_for_abort():
    allocator, left = Allocator(), [0, 1, 1, 1, 1, 1, 1]
    allocator.run(1.0, np.zeros(6), budget(left))
    trouble = allocator.part.trouble()
    assert trouble.level == ERROR
    assert "surge lost" in trouble.text
    assert "abort" not in trouble.text
    allocator.run(4.0, np.zeros(6), budget(left, [-1.0, 0, 0, 0, 0, 0]))
    assert "cannot hold it: abort" in allocator.part.trouble().text
    assert allocator.part.status()["authority_surge"] == 0.0
    allocator.run(0.1, np.zeros(6), budget([1] * 7))
    assert allocator.part.trouble() is None


def test_saturation_and_what_is_missing_are_told_after_a_while():
    allocator = Allocator()
    allocator.run(1.0, [200.0, 0, 0, 0, 0, 0])
    assert allocator.part.trouble() is None
    allocator.run(3.0, [200.0, 0, 0, 0, 0, 0])
    trouble = allocator.part.trouble()
    assert trouble.level == WARN  # whole thrusters that are asked for too much have not failed
    assert "surge: not achieved for more than 2 s" in trouble.text
    assert "main at the limit for more than 3 s" in trouble.text


def test_a_suspicion_does_not_make_a_dead_thruster_whole():
    belief = ThrusterBelief(NAMES, {})
    belief.estimate(ThrusterHealth(np.array([0.0, 1.0, 1.0]), np.array([0.03, 0.2, 0.2])))
    belief.estimate(ThrusterHealth(np.array([0.9, 1.0, 1.0]), np.array([0.9, 0.2, 0.2])))
    assert belief.effectiveness[0] == 0.0
    belief.estimate(ThrusterHealth(np.array([0.95, 1.0, 1.0]), np.array([0.05, 0.2, 0.2])))
    assert belief.effectiveness[0] == 1.0


def test_an_estimate_of_other_thrusters_is_refused():
    with pytest.raises(SignalError, match="has 2 thrusters; the vehicle has 3"):
        ThrusterBelief(NAMES, {}).estimate(ThrusterHealth(np.ones(2), np.ones(2)))
