"""The Coriolis matrix: the kernels' forces, and the skew symmetry that passivity rests on."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import norm_error, random_motion, random_vehicle

from uvms_dynamics import build_model, inverse_dynamics, mass_matrix
from uvms_dynamics.numpy_reference.coriolis import coriolis_matrix

CASES = st.tuples(st.integers(0, 2**32 - 1), st.sampled_from([1, 2, 3, 4, 7, 16]))
quick = settings(max_examples=20, deadline=None, derandomize=True)


def case(seed, n):
    vehicle = random_vehicle(seed, n, drag=False)
    return vehicle, build_model(vehicle), random_motion(np.random.default_rng(seed), n)


@quick
@given(CASES)
def test_it_gives_the_kernels_coriolis_forces(seed_and_n):
    vehicle, model, motion = case(*seed_and_n)
    rest, still = np.zeros(6), np.zeros(vehicle.n_joints)
    weight = inverse_dynamics(model, motion.quat, rest, rest, motion.q, still, still)
    bias = inverse_dynamics(model, motion.quat, motion.nu, rest, motion.q, motion.q_dot, still)
    found = coriolis_matrix(vehicle, motion.nu, motion.q, motion.q_dot)
    zeta = np.concatenate([motion.nu, motion.q_dot])
    assert norm_error(found @ zeta, bias - weight) < 1e-12


@quick
@given(CASES)
def test_no_motion_gets_power_from_it(seed_and_n):
    """x^T (M_dot - 2 C) x = 0 for every x, with M_dot of the kernel along the motion."""
    vehicle, model, motion = case(*seed_and_n)

    def change(h):
        ahead, behind = (mass_matrix(model, motion.q + s * h * motion.q_dot) for s in (1.0, -1.0))
        return (ahead - behind) / (2.0 * h)

    slope = (4.0 * change(1e-4) - change(2e-4)) / 3.0
    found = slope - 2.0 * coriolis_matrix(vehicle, motion.nu, motion.q, motion.q_dot)
    assert norm_error(found, -found.T) < 1e-8
    for x in np.random.default_rng(1).normal(size=(5, len(found))):
        assert abs(x @ found @ x) < 1e-8 * np.linalg.norm(found @ x) * np.linalg.norm(x)
