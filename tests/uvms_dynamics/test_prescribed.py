"""The floating base under a prescribed motion of the arm."""

import numpy as np
import pytest
from random_vehicles import random_motion, random_vehicle
from urdf_chains import real_vehicle

from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import build_model, forward_dynamics, quat_to_matrix, restoring_wrench
from uvms_dynamics.simulation.prescribed import (
    Load,
    PrescribedJoints,
    base_acceleration,
    base_inertia,
    float_freely,
)

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def still(q, steps, step=0.05):
    """A motion in which the arm holds its pose."""
    rows = 2 * steps + 1
    none = np.zeros((rows, len(q)))
    return PrescribedJoints(np.full(steps, step), np.tile(q, (rows, 1)), none, none)


def state(quat, nu=(0.0,) * 6):
    return np.concatenate([np.zeros(3), quat, nu])


@pytest.mark.parametrize(("seed", "n"), [(41, 1), (42, 4), (43, 8)])
def test_it_is_forward_dynamics_when_driven_by_its_joint_accelerations(seed, n):
    model = build_model(random_vehicle(seed, n))
    motion = random_motion(np.random.default_rng(seed), n)
    tau = np.concatenate([np.zeros(6), np.linspace(-5.0, 5.0, n)])
    whole = forward_dynamics(model, motion.quat, motion.nu, motion.q, motion.q_dot, tau)
    inverse = np.linalg.inv(base_inertia(model, motion.q[None]))[0]
    base = base_acceleration(
        model,
        np.zeros(4),
        inverse,
        state(motion.quat, motion.nu),
        motion.q,
        motion.q_dot,
        whole[6:],
    )
    np.testing.assert_allclose(base, whole[:6], rtol=1e-9, atol=1e-9 * np.abs(whole).max())


def test_it_comes_to_rest_where_weight_and_buoyancy_balance():
    damping = [20.0, 20.0, 20.0, 2.0, 2.0, 2.0]
    vehicle = real_vehicle(**{"hull.linear_damping": damping, "tether": None})
    model, q = build_model(vehicle), np.radians([40.0, 90.0, 30.0, 0.0])
    end = float_freely(model, state(LEVEL), still(q, 1200), Load())[-1]
    assert np.abs(end[10:]).max() < 1e-4
    moment = restoring_wrench(model, end[3:7], q)[3:]
    assert np.abs(moment).max() < 2e-3  # what the drag of its rise leaves
    tilted = np.degrees(np.arccos(quat_to_matrix(end[3:7])[2, 2]))
    assert tilted > 1.5


def test_a_load_is_an_attachment():
    vehicle = random_vehicle(44, 3)
    place, weight = np.array([0.3, -0.2, 0.4]), 7.0
    data = vehicle.model_dump(mode="json")
    data["hull"]["attachments"] = [
        {"name": "lead", "position_m": place.tolist(), "wet_weight_n": weight}
    ]
    heavy, motion = vehicle_from_data(data), still(np.zeros(3), 20)
    expected = float_freely(build_model(heavy), state(LEVEL), motion, Load())
    load = Load(weight=weight, moment=weight * place)
    found = float_freely(build_model(vehicle), state(LEVEL), motion, load)
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_a_load_changes_with_depth_and_fades_with_time():
    """At a given depth, and at once, those parts are the constant ones; later one is gone."""
    model, motion = build_model(random_vehicle(45, 2)), still(np.zeros(2), 1, 1e-3)
    deep = state(LEVEL)
    deep[2] = 3.0
    moment = np.array([2.0, -1.0, 0.5])
    expected = float_freely(model, deep, motion, Load(weight=4.0, moment=moment))[-1, 7:]
    data = random_vehicle(45, 2).model_dump(mode="json")
    data["tether"] = {
        "reference_depth_m": 1.0,
        "weight_per_m_n": 2.0,
        "moment_per_m_nm": (moment / 2.0).tolist(),
    }
    tethered = build_model(vehicle_from_data(data))
    found = float_freely(tethered, deep, motion, Load())[-1, 7:]
    np.testing.assert_allclose(found, expected, rtol=1e-4)
    slow = Load(weight=4.0, moment_fading=moment, fading_time=1e6)
    np.testing.assert_allclose(float_freely(model, deep, motion, slow)[-1, 7:], expected, rtol=1e-6)
    quick = Load(weight=4.0, moment_fading=moment, fading_time=1e-9)
    gone = float_freely(model, deep, motion, Load(weight=4.0))[-1, 7:]
    found = float_freely(model, deep, motion, quick)[-1, 7:]
    np.testing.assert_allclose(found, gone, atol=0.2 * np.abs(expected - gone).max())


def test_fourth_order():
    """Half the step, a sixteenth of the error."""
    model, q = build_model(real_vehicle()), np.radians([40.0, 90.0, 30.0, 0.0])
    ends = [
        float_freely(model, state(LEVEL), still(q, count, 4.0 / count), Load())[-1]
        for count in (20, 40, 80)
    ]
    ratio = np.abs(ends[0] - ends[1]).max() / np.abs(ends[1] - ends[2]).max()
    assert 12.0 < ratio < 20.0
