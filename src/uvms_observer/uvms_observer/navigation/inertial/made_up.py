"""What readings that were held back leave to be made up for, once they are believed."""

import numpy as np

from uvms_observer.navigation.inertial.screen import Jump
from uvms_observer.navigation.inertial.unknown_motion import change_velocity, spread
from uvms_observer.navigation.state import INERTIAL_BIASES, NavigationState

MOST = np.repeat([np.radians(1.0), 0.1], 3)
"""Std of the bias of a unit, rad/s and m/s^2, whose readings have stepped by more: it is rather the
vehicle that was pushed."""
KNOCK_M = 0.02
"""Change of velocity by a knock that falls between two readings, m/s, for each rad/s by which the
rate has changed: the arm about which it turns the unit, less what the readings have of it."""


def make_up_for(state: NavigationState, jump: Jump, dt: float) -> None:
    """What the readings would have changed within dt, s, and what they do not say; in place."""
    change_velocity(tuple(state), jump.owed)
    unseen = KNOCK_M * float(np.linalg.norm(jump.rate))
    spread(tuple(state), np.zeros(3), np.full(3, unseen), dt)
    if jump.stays:
        step = np.concatenate((jump.rate, jump.force))
        doubt = np.square(np.clip(step, -MOST, MOST))
        state.covariance[INERTIAL_BIASES, INERTIAL_BIASES] += np.diag(doubt)
