"""What a named fault explains leaves the filtered wrench as if it had always been counted."""

import numpy as np
import pytest

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix
from uvms_observer.health import Handover
from uvms_observer.health.monitor import Fault

MATRIX = thruster_matrix(load_vehicle())
GAIN = np.array([0.05, 0.08, 0.1, 0.1, 0.07, 0.12])
DEAD, ONSET, NAMED, COUNTED, END = 3, 10, 22, 24, 60


def filtered(force):
    """First-order filter of (k, 6)."""
    state = np.zeros(6)
    for each in force:
        state = state + GAIN * (each - state)
    return state


def handed_over(thrust, share, counted):
    """The filtered wrench where the fault is named at NAMED; `counted` (k,) by the allocator."""
    handover, state, whole = Handover(MATRIX), np.zeros(6), np.ones(MATRIX.shape[1])
    for t in range(END):
        shares = whole.copy()
        shares[DEAD] = counted[t]
        missing = share * (t >= ONSET) - (1.0 - counted[t])
        force = -MATRIX[:, DEAD] * missing * thrust[t]
        if t == NAMED:
            fault = Fault(DEAD, share, thrust[ONSET : NAMED + 1])
            state = state + handover.remembered(fault, GAIN, shares)
        explained = handover.of_interval(thrust[t] * whole, shares)
        state = state + GAIN * (force + (0.0 if explained is None else explained) - state)
    return state


@pytest.mark.parametrize("share", [0.4, 1.0])
def test_nothing_of_the_fault_is_left(share):
    thrust = np.random.default_rng(1).normal(20.0, 10.0, END)
    counted = np.where(np.arange(END) < COUNTED, 1.0, 1.0 - share)
    assert handed_over(thrust, share, counted) == pytest.approx(np.zeros(6), abs=1e-12)


def test_where_a_user_says_that_it_is_whole_the_loss_is_external_again():
    thrust = np.full(END, 30.0)
    left = handed_over(thrust, 1.0, np.ones(END))
    force = np.zeros((END, 6))
    force[NAMED + 5 :] = -MATRIX[:, DEAD] * 30.0
    assert left == pytest.approx(filtered(force), abs=1e-9)
    assert left @ MATRIX[:, DEAD] < -20.0
