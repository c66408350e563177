"""The arm makes up for where a hull rests that no thruster turns, and leaves its swing alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_control.controlled_axes import axes_of
from uvms_control.hull_swing import SLOWER, HullSwing, rest_tilt
from uvms_control.tracking_error import TrackingError
from uvms_core.vehicle import joint_limits, load_vehicle
from uvms_core.vehicle.locate import vehicle_path
from uvms_dynamics import build_model, mass_matrix, restoring_wrench, rpy_to_quat

BLUEROV2 = load_vehicle(vehicle_path("bluerov2_alpha5"))
MODEL = build_model(BLUEROV2)
LOWER, UPPER = joint_limits(BLUEROV2)
FOLDED = np.radians([36.0, 143.0, 138.0, 0.0])
"""The posture in which a plan of the paper's path leaves the arm."""
MASS = mass_matrix(MODEL, FOLDED)
CONTROLLED = axes_of(BLUEROV2).is_controlled
DT = 0.05


def swing_of(error, rate, swing, q=FOLDED, q_dot=None):
    tracking = TrackingError(np.asarray(error), np.asarray(rate), np.zeros(6))
    motion = q, np.zeros(4) if q_dot is None else q_dot
    return swing.step(MODEL, motion, MASS, tracking, CONTROLLED, DT)


def pitch_only(value):
    return np.array([0.0, 0.0, 0.0, 0.0, value, 0.0])


@settings(deadline=None, max_examples=50)
@given(st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4).map(np.array))
def test_at_rest_weight_and_buoyancy_make_no_moment_about_the_axis(shares):
    q = LOWER + shares * (UPPER - LOWER)
    tilt, stiffness = rest_tilt(MODEL, q)
    assert stiffness > 0.0
    for k, rpy in enumerate([(tilt[0], 0.0, 0.0), (0.0, tilt[1], 0.0)]):
        moment = restoring_wrench(MODEL, rpy_to_quat(*rpy), q)[3 + k]
        assert moment == pytest.approx(0.0, abs=1e-9)


def test_only_pitch_is_left_to_the_hull_of_the_bluerov2():
    assert list(np.flatnonzero(~CONTROLLED)) == [4]
    error, rate = swing_of(np.full(6, 0.1), np.full(6, 0.1), HullSwing())
    assert list(np.flatnonzero(error)) == [4] == list(np.flatnonzero(rate))


def test_a_hull_where_the_model_has_it_at_rest_does_not_swing():
    error, rate = swing_of(pitch_only(-rest_tilt(MODEL, FOLDED)[0][1]), np.zeros(6), HullSwing())
    np.testing.assert_allclose(error, 0.0, atol=1e-12)
    np.testing.assert_allclose(rate, 0.0, atol=1e-12)


def test_the_rest_goes_with_the_arm_without_lag():
    q_dot = np.radians([3.0, 8.0, -5.0, 0.0])
    swing = HullSwing()
    for k in range(100):
        q = FOLDED - (2.0 - k * DT) * q_dot
        here, ahead = (rest_tilt(MODEL, each)[0][1] for each in (q, q + DT * q_dot))
        tilt_rate = (ahead - here) / DT
        error, rate = swing_of(pitch_only(-here), pitch_only(-tilt_rate), swing, q, q_dot)
        np.testing.assert_allclose(error, 0.0, atol=1e-12)
        np.testing.assert_allclose(rate, 0.0, atol=1e-12)


def test_of_a_swing_a_seventeenth_is_followed_and_of_a_lasting_error_all():
    """|1 / (1 + 4 j)^2| = 1 / 17 at the hull's own frequency."""
    rest, stiffness = rest_tilt(MODEL, FOLDED)
    w = np.sqrt(stiffness / MASS[4, 4])
    swing, followed = HullSwing(), []
    lasting, size = np.radians(2.0), np.radians(3.0)
    for k in range(int(30 * SLOWER / w / DT)):
        moves = size * np.sin(w * k * DT)
        own = pitch_only(lasting - rest[1] + moves)
        error, _ = swing_of(own, pitch_only(w * size * np.cos(w * k * DT)), swing)
        followed.append(own[4] + rest[1] - error[4])
    late = np.array(followed[-int(4 * np.pi / w / DT) :])
    assert late.mean() == pytest.approx(lasting, rel=0.02)
    assert np.ptp(late) / 2 == pytest.approx(size / (1 + SLOWER**2), rel=0.05)
