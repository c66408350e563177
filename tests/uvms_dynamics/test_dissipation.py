"""What the water takes: drag never adds energy, whatever moves."""

import numpy as np
from free_run import FreeRun
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import REFERENCE, changed, random_motion, random_vehicle

from uvms_dynamics import build_model, hull_bias_wrench, inverse_dynamics, quat_to_matrix
from uvms_dynamics.simulation.integrator import JOINTS

CASES = st.tuples(st.integers(0, 2**32 - 1), st.sampled_from([1, 2, 4, 7]))
SPEEDS = st.floats(-4.0, 1.5).map(lambda exponent: 10.0**exponent)
CURRENTS = st.lists(st.floats(-3.0, 3.0), min_size=3, max_size=3).map(np.array)
quick = settings(max_examples=60, deadline=None, derandomize=True)


@quick
@given(CASES, SPEEDS, CURRENTS)
def test_drag_takes_power_from_every_motion_through_the_water(seed_and_n, speed, current):
    """Hull and links together, and the links alone, against the motion relative to the current."""
    seed, n = seed_and_n
    wet, smooth = random_vehicle(seed, n), random_vehicle(seed, n, drag=False)
    motion = random_motion(np.random.default_rng(seed), n)
    nu_r, q_dot = speed * motion.nu, speed * motion.q_dot
    nu_r[:3] -= quat_to_matrix(motion.quat).T @ current
    still = np.zeros(6), motion.q, q_dot, np.zeros(n)
    drag = inverse_dynamics(build_model(wet), motion.quat, nu_r, *still)
    drag -= inverse_dynamics(build_model(smooth), motion.quat, nu_r, *still)
    hull = hull_bias_wrench(build_model(wet), nu_r) - hull_bias_wrench(build_model(smooth), nu_r)
    of_all, of_hull = np.concatenate([nu_r, q_dot]) @ drag, nu_r @ hull
    assert of_all > 0.0
    assert of_hull > 0.0
    assert of_all - of_hull > -1e-9 * of_all


def test_energy_falls_with_drag_and_friction():
    run = FreeRun(REFERENCE, seed=3)
    energy = [run.energy(x) for x in run.go(10.0, 0.005)[::20]]
    assert (np.diff(energy) < 0.0).all()


def test_energy_that_drag_takes_is_the_integral_of_its_power():
    """In a level current; no friction and no stops. Simpson's rule over the steps."""
    data_of, smooth = changed(REFERENCE, drag=False), build_model(changed(REFERENCE, drag=False))
    vehicle = data_of.model_copy(
        update={
            "hull": REFERENCE.hull,
            "arm": data_of.arm.model_copy(update={"links": REFERENCE.arm.links}),
        }
    )
    run = FreeRun(vehicle, seed=3, current=(0.5, -1.0, 0.0))
    step = 0.005
    states = run.go(5.0, step)

    def power(x):
        nu_r, q_dot = run.velocity(x)[:6], run.velocity(x)[6:]
        args = x[3:7], nu_r, np.zeros(6), x[JOINTS : JOINTS + 4], q_dot, np.zeros(4)
        drag = inverse_dynamics(run.system.model, *args) - inverse_dynamics(smooth, *args)
        return run.velocity(x) @ drag

    values = np.array([power(x) for x in states])
    taken = (
        step
        / 3.0
        * (values[0] + values[-1] + 4.0 * values[1::2].sum() + 2.0 * values[2:-1:2].sum())
    )
    lost = run.energy(states[0]) - run.energy(states[-1])
    assert taken > 1.0
    np.testing.assert_allclose(lost, taken, rtol=1e-6)
