"""The greatest stable step: a little below it modes die out, a little above it they grow."""

import numpy as np
import pytest
from free_run import FreeRun
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from random_vehicles import changed, random_vehicle
from scipy.linalg import eigh

from uvms_core.vehicle import load_vehicle, vehicle_from_data
from uvms_dynamics import build_model, mass_matrix
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.integrator import (
    JOINTS,
    QUATERNION,
    VELOCITY,
    System,
    advance,
    make_scratch,
)
from uvms_dynamics.simulation.plant.config import initial_state
from uvms_dynamics.simulation.plant.operating_points import AXES, operating_points
from uvms_dynamics.simulation.plant.stability import (
    amplification,
    cause_of,
    greatest_step,
    jacobian,
    stable_steps,
)
from uvms_dynamics.simulation.thrusters import build_thrusters

REAL, IMAGINARY = 2.785293563405282, np.sqrt(8.0)
"""Ends of the region on its axes (Hairer and Wanner 1996, sec. IV.2): R(-x) = 1 and |R(iy)| = 1."""

STEPS = 4
RNG = np.random.default_rng
exponents = st.floats(0.0, 1.0)
quick = settings(max_examples=12, deadline=None, derandomize=True, phases=[Phase.generate])


def system_of(vehicle, config):
    current = np.array(config.current_ned_m_s, dtype=float)
    return System(build_model(vehicle), build_thrusters(vehicle), current)


def run(system, point, start, step, steps):
    """States (steps+1, nx) from a start under the point's own commands."""
    n = len(point.effort)
    thrust, states = point.state[JOINTS + 2 * n :].copy(), np.empty((steps + 1, len(start)))
    scratch = make_scratch(system)
    x, rates = start.copy(), np.empty_like(states)
    advance(system, x, thrust, point.effort, step, scratch, states, rates, 0.0)
    return states


def gain(vehicle, config, bound, part):
    """What a few steps of a part of the greatest make of a small push along the fastest mode.

    Runge-Kutta by hand on the plant's own rates, less those of the operating point: it is held.
    """
    system, start = system_of(vehicle, config), bound.point.state
    left, _, right = np.linalg.svd(bound.slope - bound.eigenvalue * np.eye(len(bound.slope)))
    push = np.zeros(len(start))
    push[QUATERNION:] = 1e-7 * right[-1].conj().real / np.abs(right[-1]).max()

    def rates(x):
        return rates_at(system, bound.point, x) - rates_at(system, bound.point, start)

    x, h = start + push, part * bound.step_s
    for _ in range(STEPS):
        k1 = rates(x)
        k2 = rates(x + 0.5 * h * k1)
        k3 = rates(x + 0.5 * h * k2)
        x = x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rates(x + h * k3))
    mode = left[:, -1].conj()
    return abs(mode @ (x - start)[QUATERNION:]) / abs(mode @ push[QUATERNION:])


def rates_at(system, point, x):
    scratch, row = make_scratch(system), np.empty((1, len(x)))
    rates, thrust = np.empty((1, len(x))), point.state[JOINTS + 2 * len(point.effort) :].copy()
    advance(system, x.copy(), thrust, point.effort, 0.0, scratch, row, rates, 0.0)
    return rates[0]


def assert_sharp(vehicle, config, cause):
    bound = greatest_step(vehicle, config)
    assert cause_of(vehicle, bound).startswith(cause)
    assert gain(vehicle, config, bound, 0.9) < 1.0
    assert gain(vehicle, config, bound, 1.3) > 4.0
    assert_bounded(vehicle, config, bound)


def assert_bounded(vehicle, config, bound):
    """Half a second or more at 0.9 of the bound is no wilder than at a twentieth of it."""
    system, steps = system_of(vehicle, config), 200
    coarse = run(system, bound.point, bound.point.state, 0.9 * bound.step_s, steps)
    fine = run(system, bound.point, bound.point.state, 0.045 * bound.step_s, 20 * steps)
    fastest = np.abs(fine[:, VELOCITY:]).max(axis=0)
    assert (np.abs(coarse[:, VELOCITY:]).max(axis=0) <= 1.5 * fastest + 1e-2).all()


def test_the_region_on_its_axes():
    steps = stable_steps(np.array([-1.0, -50.0, 1j, -4j]))
    np.testing.assert_allclose(steps, [REAL, REAL / 50.0, IMAGINARY, IMAGINARY / 4.0])


def test_a_mode_that_decays_never_grows_below_the_bound():
    """All directions of the left half plane, all steps up to the bound, and just beyond it."""
    direction = np.exp(1j * np.linspace(0.5 * np.pi + 1e-9, 1.5 * np.pi - 1e-9, 201))
    bound = stable_steps(direction)
    for part in np.linspace(0.0, 1.0, 101):
        assert np.abs(amplification(part * bound * direction)).max() < 1.0 + 1e-8
    assert np.abs(amplification(1.001 * bound * direction)).min() > 1.0


def test_a_mode_that_grows_may_grow_as_it_does():
    """Up to the bound Runge-Kutta gains at most a hundredth a step over the exact flow."""
    direction = np.exp(1j * np.linspace(-0.49 * np.pi, 0.49 * np.pi, 101))
    bound = np.minimum(stable_steps(direction), 4.0)
    assert bound.min() > 1.0
    z = bound * direction
    assert (np.abs(amplification(z)) < 1.0101 * np.exp(z.real)).all()


def test_modes_at_rest_are_those_of_mass_and_friction():
    """Viscous friction alone: -1/s of the fastest is the greatest of D x = s M x."""
    friction = {f"arm.joints.{name}.coulomb_friction_nm": 0.0 for name in NAMES}
    friction |= {f"arm.joints.{name}.viscous_friction_nm_s": 50.0 for name in NAMES}
    vehicle = load_vehicle(overrides=friction)
    config = PlantConfig()
    rest = list(operating_points(vehicle, build_model(vehicle), config))[1]
    assert rest.name == "with the arm stowed"
    found = np.linalg.eigvals(jacobian(vehicle, system_of(vehicle, config), rest))
    damping = np.diag([*vehicle.hull.linear_damping, *[50.0] * 4])
    matrix = mass_matrix(build_model(vehicle), np.radians(vehicle.arm.stowed_deg))
    expected = eigh(damping, matrix, eigvals_only=True)[-4:]
    np.testing.assert_allclose(np.sort(-found.real)[-4:], expected, rtol=1e-2)
    for thruster in vehicle.thrusters:
        assert np.abs(found + 1.0 / thruster.time_constant_s).min() < 1e-6


NAMES = ("swing", "shoulder", "elbow", "wrist")
joints = st.sampled_from(NAMES)


def vehicle_with(changes):
    return load_vehicle(overrides=changes)


@quick
@given(joints, exponents)
def test_stiff_viscous_friction(name, size):
    changes = {f"arm.joints.{name}.viscous_friction_nm_s": 300.0 * 30.0**size}
    i = NAMES.index(name)
    assert_sharp(vehicle_with(changes), PlantConfig(), f"friction of arm.joints.{i} ({name})")


@quick
@given(joints, exponents)
def test_steep_coulomb_friction(name, size):
    changes = {f"arm.joints.{name}.coulomb_width_deg_s": 0.05 * 0.1**size}
    i = NAMES.index(name)
    assert_sharp(vehicle_with(changes), PlantConfig(), f"friction of arm.joints.{i} ({name})")


@quick
@given(joints, exponents)
def test_stiff_stops(name, size):
    """Below the bound a bounce loses energy, in the mean over where in a step it begins."""
    vehicle = with_elastic_stop(name, 3e5 * 30.0**size)
    bound = greatest_step(vehicle, PlantConfig())
    index = NAMES.index(name)
    assert cause_of(vehicle, bound) == f"stop_stiffness_nm_rad of arm.joints.{index} ({name})"
    assert bounce(vehicle, index, bound, 0.9) < 0.0
    assert bounce(vehicle, index, bound, 1.3) > 0.0


def with_elastic_stop(name, stiffness):
    data = changed(load_vehicle(), drag=False, gravity=False).model_dump(mode="json")
    joint = data["arm"]["joints"][NAMES.index(name)]
    joint.update(stop_stiffness_nm_rad=stiffness, stop_dissipation_s_rad=0.0)
    return vehicle_from_data(data)


def bounce(vehicle, i, bound, part, phases=40):
    """Mean logarithm of the energy after a bounce over that before, in the bound's own pose."""
    step, logs = part * bound.step_s, []
    for phase in (np.arange(phases) + 0.5) / phases:
        free = FreeRun(vehicle, 0)
        free.state = bound.point.state.copy()
        rates = free.state[JOINTS + free.n : JOINTS + 2 * free.n]
        rates[np.arange(free.n) != i] = 0.0  # the others have no stop
        end = vehicle.arm.joints[i].upper_deg if rates[i] > 0.0 else vehicle.arm.joints[i].lower_deg
        free.state[JOINTS + i] = np.radians(end) - phase * step * rates[i]
        states = free.go(12 * step, step)
        assert free.stored_in_stops(states[-1]) == 0.0  # it is over
        logs.append(np.log(free.energy(states[-1]) / free.energy(states[0])))
    return np.mean(logs)


@quick
@given(joints, exponents)
def test_stops_that_dissipate_much(name, size):
    changes = {f"arm.joints.{name}.stop_dissipation_s_rad": 30.0 * 10.0**size}
    cause = f"stop_dissipation_s_rad of arm.joints.{NAMES.index(name)} ({name})"
    assert_sharp(vehicle_with(changes), PlantConfig(), cause)


@quick
@given(st.integers(0, 6), exponents)
def test_a_short_thruster_lag(i, size):
    name = load_vehicle().thrusters[i].name
    changes = {f"thrusters.{name}.time_constant_s": 2e-3 * 0.01**size}
    assert_sharp(vehicle_with(changes), PlantConfig(), f"time_constant_s of thrusters.{i} ({name})")


@quick
@given(st.integers(0, 2), exponents)
def test_a_hull_of_much_drag_in_a_current(k, size):
    damping = [17.4, 367.0, 367.0, 0.79, 108.0, 108.0]
    damping[k] = 1e5 * 10.0**size
    current = [0.0, 0.0, 0.0]
    current[k] = 3.0
    vehicle = vehicle_with({"hull.quadratic_damping": damping})
    config = PlantConfig(current_ned_m_s=tuple(current))
    assert_sharp(vehicle, config, f"damping of the hull in {AXES[k]}")


@quick
@given(exponents, st.floats(1.0, 3.0))
def test_a_light_arm_of_much_drag_in_a_current(size, speed):
    """Wide shells that weigh little: their drag is fast against their inertia."""
    data = {"arm.joints.wrist.rotor_inertia_kg_m2": 1e-3, "arm.joints.wrist.effort_limit_nm": 0.01}
    data |= {
        "arm.joints.wrist.coulomb_friction_nm": 0.0,
        "arm.joints.wrist.viscous_friction_nm_s": 0.0,
        "arm.joints.wrist.stop_stiffness_nm_rad": 0.0,
    }
    shell = {"center_m": [0.15, 0.0, 0.09], "axis": [0.0, 0.0, 1.0], "length_m": 0.3}
    shell |= {"radius_m": 0.5 * 4.0**size, "stations": 4}
    vehicle = vehicle_with(data | {"arm.links.gripper.drag": [shell]})
    config = PlantConfig(current_ned_m_s=(0.0, 0.0, speed))
    assert_sharp(vehicle, config, "drag of the links about arm.joints.3 (wrist)")


@pytest.mark.parametrize("n", [1, 3, 8])
def test_any_vehicle(n):
    for seed in range(3):
        vehicle, config = random_vehicle(seed, n), PlantConfig(current_ned_m_s=(1.0, -1.0, 0.5))
        bound = greatest_step(vehicle, config)
        assert gain(vehicle, config, bound, 0.9) < 1.0 or bound.eigenvalue.real > 0.0
        assert gain(vehicle, config, bound, 1.3) > 4.0 or bound.point.strikes


WILD = {
    "as it is": {},
    "friction": {"arm.joints.swing.viscous_friction_nm_s": 3000.0},
    "stop": {
        "arm.joints.elbow.stop_stiffness_nm_rad": 1e6,
        "arm.joints.elbow.stop_dissipation_s_rad": 0.1,
    },
    "lag": {"thrusters.main.time_constant_s": 1e-4},
    "drag": {"hull.quadratic_damping": [17.0, 3e5, 367.0, 0.8, 108.0, 108.0]},
}


def fastest_joint(vehicle, config, step, seconds=5.0):
    """Greatest joint rate under full torque and thrust, one way or the other at random."""
    system, x, rng = system_of(vehicle, config), initial_state(vehicle, config), RNG(1)
    scratch, rates = make_scratch(system), []
    torque = np.array([joint.effort_limit_nm for joint in vehicle.arm.joints])
    force = np.array([thruster.greatest_n for thruster in vehicle.thrusters])
    states = np.empty((max(1, round(0.5 / step)) + 1, len(x)))
    for _ in range(round(seconds / 0.5)):
        effort = torque * rng.choice([-1.0, 0.0, 1.0], len(torque))
        thrust = force * rng.choice([-1.0, 1.0], len(force))
        advance(system, x, thrust, effort, step, scratch, states, np.empty_like(states), 0.0)
        rates.append(np.abs(states[:, JOINTS + 4 : JOINTS + 8]).max())
    return np.max(rates)  # not a number where any is not


@pytest.mark.parametrize("name", WILD)
def test_a_wild_run_in_a_current_stays_bounded_below_the_bound(name):
    """Through all poses, not only those that the bound was found in, and far beyond rate limits.

    Where a stop begins within a step, a bounce may come out up to twice as fast, by where the step
    happens to fall.
    """
    vehicle, config = vehicle_with(WILD[name]), PlantConfig(current_ned_m_s=(1.0, -2.0, 0.0))
    bound = greatest_step(vehicle, config).step_s
    calm = fastest_joint(vehicle, config, 0.3 * bound)
    assert fastest_joint(vehicle, config, 0.9 * bound) < 2.5 * calm
    if name == "friction":  # and what the refusal is good for
        assert not fastest_joint(vehicle, config, 2.0 * bound) < 10.0 * calm
