"""The kernel of the usual inertial sample against the steps that it stands for."""

import numpy as np
import pytest
from nav_states import NOISE, random_state

from uvms_observer.navigation.inertial.at_once import UNUSUAL, take_inertial
from uvms_observer.navigation.measurements.imu import correct_attitude
from uvms_observer.navigation.propagation import propagate

RATE, FORCE = np.array([0.1, -0.2, 0.3]), np.array([0.4, -0.3, -9.6])
STEP = np.array([0.01, 0.0, 0.0])
VARIANCE = np.array([1e-4, 1e-4, 4e-4])
MEAN = np.array([1.0, -2.0, 0.5, 0.0, 0.0, 0.0])


def taken(state, quaternion, gate=1e9, force=FORCE):
    return take_inertial(
        *(state, RATE, RATE + STEP, 0.02, FORCE, force, 0.1),
        *(0.01, 9.81, *NOISE, quaternion, VARIANCE, gate, MEAN, 0.9),
    )


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("gate", [1e9, 1e-9])
def test_it_is_propagation_and_correction_in_one(seed, gate):
    ours, theirs = random_state(seed), random_state(seed)
    quaternion = theirs.quaternion.copy()
    distance, mean = taken(tuple(ours), quaternion, gate)
    propagate(tuple(theirs), RATE, RATE + STEP, FORCE, FORCE, 0.01, 9.81, *NOISE)
    assert distance == correct_attitude(tuple(theirs), quaternion, VARIANCE, gate)
    for one, other in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(one, other)
    told = theirs.innovation[0, :3] / theirs.innovation[2, :3]
    np.testing.assert_allclose(mean[:3], 0.9 * MEAN[:3] + np.sqrt(1.0 - 0.9**2) * told)


def test_a_reading_that_leaves_the_last_one_is_for_the_screen():
    state, before = random_state(1), random_state(1)
    distance, mean = taken(tuple(state), before.quaternion.copy(), force=FORCE + 0.2)
    assert distance == UNUSUAL
    np.testing.assert_array_equal(mean, MEAN)
    for one, other in zip(state, before, strict=True):
        np.testing.assert_array_equal(one, other)
