"""Friction and end stops."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import REFERENCE

from uvms_dynamics import build_model, joint_passive_torque

untimed = settings(deadline=None)  # the first call compiles
MODEL = build_model(REFERENCE)
RATES = st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4).map(np.array)
ANGLES = st.lists(st.floats(-4.0, 4.0), min_size=4, max_size=4).map(np.array)
MIDDLE = np.radians([0.0, 30.0, 60.0, 0.0])


@untimed
@given(RATES)
def test_friction_never_gives_energy(rates):
    assert (joint_passive_torque(MODEL, MIDDLE, rates) * rates <= 0.0).all()


def test_friction_slides_at_its_coulomb_level():
    torque = joint_passive_torque(MODEL, MIDDLE, np.full(4, 2.0))
    np.testing.assert_allclose(torque, [-2.5, -2.5, -2.4, -1.2], rtol=1e-6)


@untimed
@given(ANGLES, RATES)
def test_stops_push_inward_and_never_pull(angles, rates):
    stop = joint_passive_torque(MODEL, angles, rates) - joint_passive_torque(MODEL, MIDDLE, rates)
    for joint, angle, torque in zip(REFERENCE.arm.joints, np.degrees(angles), stop, strict=True):
        if angle > joint.upper_deg:
            assert torque <= 0.0
        elif angle < joint.lower_deg:
            assert torque >= 0.0
        else:
            assert torque == 0.0


def test_a_stop_is_a_spring_at_rest():
    depth = 0.01
    angles = MIDDLE.copy()
    angles[1] = np.radians(100.0) + depth
    torque = joint_passive_torque(MODEL, angles, np.zeros(4))
    np.testing.assert_allclose(torque, [0.0, -2000.0 * depth, 0.0, 0.0], rtol=1e-12)
