"""The arm is not stretched after a target that it cannot reach, nor along an axis that is lost."""

from dataclasses import replace

import numpy as np
import pytest
from closed_loop import at_rest
from test_compensation import WORKING, settle, tool_error, wanted

from uvms_control.compensation import as_if_held
from uvms_control.tracking_error import tracking_error
from uvms_dynamics.kernels.rotations import rotation_vector_to_quat

ALL = np.ones(6, dtype=np.bool_)


def asked(shift):
    """Length of the joint correction, rad, with the vehicle displaced."""
    correction, _ = settle(at_rest(WORKING, shift), wanted())
    return float(np.linalg.norm(correction.angle))


@pytest.mark.parametrize("way", [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, 0, -1), (0.6, 0.6, 0.5)])
def test_a_vehicle_that_is_carried_away_takes_the_arm_along(way):
    reach = max(asked(0.01 * k * np.array(way)) for k in range(1, 41))
    assert asked(5.0 * np.array(way)) < 0.03 * reach
    assert asked(1.5 * np.array(way)) < 0.2 * reach


def test_the_correction_fades_without_a_step():
    shifts = np.linspace(0.0, 2.0, 81)
    found = [settle(at_rest(WORKING, (0.0, x, 0.0)), wanted())[0].angle for x in shifts]
    steps = np.abs(np.diff(found, axis=0)).max(axis=1)
    assert steps.max() < 1.5 * steps[0]  # within reach it is as steep as this


def test_within_reach_all_of_it_is_asked_for():
    displaced = at_rest(WORKING, (0.05, 0.03, -0.04))
    correction, _ = settle(displaced, wanted())
    assert tool_error(displaced, wanted(), correction) < 1e-3


def turned(position, rpy, nu):
    vehicle = at_rest(WORKING, position)
    odometry, _ = vehicle.estimates(0)
    return replace(odometry, quaternion=rotation_vector_to_quat(np.array(rpy)), nu=np.array(nu))


def test_a_whole_vehicle_is_held_as_it_is():
    odometry = turned((0.3, 0.2, 0.1), (0.1, 0.0, 0.2), (0.1, 0.0, 0.0, 0.0, 0.0, 0.0))
    tracking = tracking_error(odometry, wanted())
    assert as_if_held(odometry, tracking, ALL) is odometry
    hull = ALL.copy()
    hull[3:5] = False  # left to the righting moment, which brings them back
    assert as_if_held(odometry, tracking, hull) is odometry


@pytest.mark.parametrize("lost", [[0], [1], [2], [5], [0, 1], [0, 1, 2, 5]])
def test_the_error_along_an_axis_that_is_lost_is_not_made_up_for(lost):
    odometry = turned((0.3, 0.2, 0.1), (0.0, 0.0, 0.2), (0.1, -0.1, 0.05, 0.0, 0.0, 0.02))
    before = tracking_error(odometry, wanted())
    is_controlled = ALL.copy()
    is_controlled[lost] = False
    held = as_if_held(odometry, before, is_controlled)
    rate = before.rate.copy()
    rate[lost] = 0.0
    assert (wanted().nu - held.nu) == pytest.approx(rate, abs=1e-12)
    left = np.linalg.norm(before.error[[i for i in range(3) if i not in lost]])
    assert np.linalg.norm(tracking_error(held, wanted()).error[:3]) == pytest.approx(
        left, abs=1e-12
    )
    if 5 in lost:
        assert tracking_error(held, wanted()).error[5] == pytest.approx(0.0, abs=1e-12)
