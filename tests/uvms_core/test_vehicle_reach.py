"""Thrusters that do not reverse: which ways they push along one axis alone."""

import numpy as np
import pytest
from scipy.optimize import linprog

from uvms_core.vehicle import examine_vehicle, load_vehicle
from uvms_core.vehicle.plausible.propulsion import axes_out_of_reach, axes_pushed_one_way
from uvms_core.vehicle.reach import reached_ways

N = load_vehicle().n_thrusters


def not_reversing(*numbers):
    changes = {f"thrusters.{i}.limit_n": None for i in numbers}
    return changes | {f"thrusters.{i}.limits_n": [0.0, 49.0] for i in numbers}


def test_the_reference_vehicle_pushes_both_ways():
    assert axes_pushed_one_way(load_vehicle()) == ()


def test_a_layout_without_reverse_is_warned_of_with_its_axes():
    examined = examine_vehicle(None, not_reversing(*range(N)))
    assert axes_out_of_reach(examined.vehicle) == ()
    axes = axes_pushed_one_way(examined.vehicle)
    assert "surge (only +)" in axes
    assert "heave (only +)" in axes
    (warning,) = (text for text in examined.warnings if "do not reverse" in text)
    assert ", ".join(axes) in warning


def test_one_main_thruster_without_reverse_takes_astern_alone():
    assert axes_pushed_one_way(load_vehicle(None, not_reversing(0))) == ("surge (only +)",)


def test_reach_agrees_with_thrusts_that_are_tried():
    """A pair that faces each other pushes both ways; one that looks one way pushes that way."""
    facing = np.zeros((6, 3))
    facing[0] = 1.0, -1.0, 0.0
    facing[1, 2] = 1.0
    ways = reached_ways(facing, np.zeros(3), np.ones(3))
    np.testing.assert_array_equal(ways[:, 0], [True, True])
    np.testing.assert_array_equal(ways[:, 1], [True, False])
    assert not ways[:, 2:].any()


@pytest.mark.parametrize("seed", range(5))
def test_a_wrench_is_reached_where_a_random_search_reaches_it(seed):
    """Twelve thrusters that do not reverse: greatest wrenches by linear programs."""
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(6, 12))
    ways = reached_ways(matrix, np.zeros(12), np.ones(12))
    for axis in range(6):
        others = np.delete(matrix, axis, axis=0)
        for row, sign in enumerate((1.0, -1.0)):
            found = linprog(
                -sign * matrix[axis], A_eq=others, b_eq=np.zeros(5), bounds=[(0.0, 1.0)] * 12
            )
            assert ways[row, axis] == (-found.fun > 1e-9)
