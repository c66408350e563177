"""Bodies in water that moves, against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import REFERENCE, norm_error, random_motion, random_vehicle
from scipy.integrate import solve_ivp
from test_flow import ALL, GRAVITY, GUST, OSCILLATING, TURNING
from water_bodies import DISPLACED, ball, drift, rates_at

from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import joint_passive_torque, quat_to_matrix
from uvms_dynamics.kernels.inverse import coupling_wrench_in, inverse_dynamics_in
from uvms_dynamics.numpy_reference import moving_water
from uvms_dynamics.numpy_reference.flow import flow_at
from uvms_dynamics.simulation import make_state, make_system, simulate
from uvms_dynamics.simulation.integrator import JOINTS, VELOCITY
from uvms_dynamics.simulation.water import CurrentConfig
from uvms_dynamics.simulation.water.airy import wave_number
from uvms_dynamics.simulation.water.surroundings import surroundings

ADDED = 0.5 * DISPLACED
DAMPING = 40.0
CASES = st.tuples(st.integers(0, 2**32 - 1), st.sampled_from([1, 3, 6]))
UNIFORM = CurrentConfig(
    constant_ned_m_s=(0.1, -0.2, 0.03), turning=TURNING, gusts=[GUST], oscillating=[OSCILLATING]
)
WAVE = {"height_m": 1.5, "period_s": 5.0, "water_depth_m": 12.0, "direction_deg": 35.0}
WAVES = CurrentConfig(waves=[WAVE])


def moving_start(vehicle, seed):
    """System in all kinds of flow, a random state, its motion and a time."""
    rng, n = np.random.default_rng(seed), vehicle.n_joints
    motion, system = random_motion(rng, n), make_system(vehicle, ALL)
    place, time = rng.uniform([-20.0, -20.0, 2.0], [20.0, 20.0, 12.0]), rng.uniform(0.0, 9.0)
    x = make_state(
        motion.q,
        vehicle.n_thrusters,
        position=place,
        quat=motion.quat,
        nu_r=motion.nu,
        q_dot=motion.q_dot,
    )
    return system, x, motion, time


def to_ground(around, motion, nu_r_dot):
    """nu and nu_dot over ground from those relative to the uniform flow."""
    to_body = quat_to_matrix(motion.quat).T
    velocity, omega = to_body @ around.velocity, motion.nu[3:]
    nu, nu_dot = motion.nu.copy(), nu_r_dot.copy()
    nu[:3] += velocity
    nu_dot[:3] += to_body @ around.acceleration - np.cross(omega, velocity)
    return nu, nu_dot


@settings(max_examples=25, deadline=None, derandomize=True)
@given(CASES)
def test_the_kernels_are_the_numpy_reference_over_ground(seed_and_n):
    """Forward, inverse and coupling, for random vehicles in currents, gusts and waves at once."""
    seed, n = seed_and_n
    vehicle = random_vehicle(seed, n)
    system, x, motion, time = moving_start(vehicle, seed)
    around = surroundings(system, x, time)

    def flow(place):
        return flow_at(ALL, place, time, vehicle.environment.gravity_m_s2)

    effort = np.random.default_rng(seed).normal(size=n)
    rates = rates_at(system, x, effort, time)
    nu, nu_dot = to_ground(around, motion, rates[VELOCITY:JOINTS])
    torque = effort + joint_passive_torque(system.model, motion.q, motion.q_dot)
    tau = np.concatenate([np.zeros(6), torque])
    state = x[:3], motion.quat, nu, motion.q, motion.q_dot
    expected = moving_water.forward_dynamics(vehicle, flow, *state, tau)
    found = np.concatenate([nu_dot, rates[JOINTS + n : JOINTS + 2 * n]])
    assert norm_error(found, expected) < 1e-9

    given_motion = motion.nu, motion.nu_dot, motion.q, motion.q_dot, motion.q_ddot
    nu, nu_dot = to_ground(around, motion, motion.nu_dot)
    expected = moving_water.inverse_dynamics(
        vehicle, flow, x[:3], motion.quat, nu, nu_dot, motion.q, motion.q_dot, motion.q_ddot
    )
    found = inverse_dynamics_in(system.model, around.wet, around.down, *given_motion)
    assert norm_error(found, expected) < 1e-10


@pytest.mark.parametrize("mass", [0.6 * DISPLACED, DISPLACED, 1.7 * DISPLACED])
def test_a_body_at_rest_is_taken_along_with_its_time_constant(mass):
    """(m + m_a) v' = -d (v - V): level, so that only the way down has to do with weight."""
    current = CurrentConfig(constant_ned_m_s=(0.3, -0.2, 0.0))
    to_rest = (-0.3, 0.2, 0.0, 0.0, 0.0, 0.0)
    times, _, velocity = drift(ball(mass, DAMPING), current, 10.0, nu_r=to_rest)
    share = 1.0 - np.exp(-times * DAMPING / (mass + ADDED))
    np.testing.assert_allclose(velocity[:, :2], share[:, None] * [0.3, -0.2], atol=1e-10)


def response(mass, omega):
    """v / V of (m + m_a) v' = (rho V + m_a) V' - d (v - V), V = exp(i omega t)."""
    pull = 1j * omega * (DISPLACED + ADDED) + DAMPING
    return pull / (1j * omega * (mass + ADDED) + DAMPING)


@pytest.mark.parametrize("mass", [0.6 * DISPLACED, DISPLACED, 1.7 * DISPLACED])
@pytest.mark.parametrize("period", [2.0, 20.0])
def test_a_body_in_an_oscillating_current(mass, period):
    omega = 2.0 * np.pi / period
    part = {"amplitude_m_s": 0.4, "period_s": period, "direction_deg": 90.0, "phase_deg": 0.0}
    times, _, velocity = drift(ball(mass, DAMPING), CurrentConfig(oscillating=[part]), 12.0)
    steady = 0.4 * np.imag(response(mass, omega) * np.exp(1j * omega * times))
    decay = np.exp(-times * DAMPING / (mass + ADDED))
    np.testing.assert_allclose(velocity[:, 1], steady - steady[0] * decay, atol=1e-9)
    np.testing.assert_allclose(velocity[:, 0], 0.0, atol=1e-12)


@pytest.mark.parametrize("mass", [0.6 * DISPLACED, 1.7 * DISPLACED])
def test_a_body_in_a_turning_current_moves_on_a_circle_behind_it(mass):
    omega, turning = 2.0 * np.pi / 6.0, {"speed_m_s": 0.5, "period_s": 6.0}
    start = (-0.5, 0.0, 0.0, 0.0, 0.0, 0.0)  # at rest over ground
    current = CurrentConfig(turning=turning)
    times, _, velocity = drift(ball(mass, DAMPING), current, 12.0, nu_r=start)
    steady = 0.5 * response(mass, omega) * np.exp(1j * omega * times)
    expected = steady - steady[0] * np.exp(-times * DAMPING / (mass + ADDED))
    np.testing.assert_allclose(velocity[:, 0] + 1j * velocity[:, 1], expected, atol=1e-9)


@pytest.mark.parametrize("mass", [0.6 * DISPLACED, DISPLACED, 1.7 * DISPLACED])
def test_a_gust_s_impulse(mass):
    """Without drag (m + m_a) v = (rho V + m_a) V at any time: taken along, and left at rest."""
    times, _, velocity = drift(ball(mass), CurrentConfig(gusts=[GUST]), 9.0)
    top, share = np.array(GUST["velocity_ned_m_s"]), (DISPLACED + ADDED) / (mass + ADDED)
    rises = (times >= 4.5) & (times <= 6.5)
    np.testing.assert_allclose(velocity[rises, :2], share * top[None, :2].repeat(rises.sum(), 0))
    np.testing.assert_allclose(velocity[times >= 8.0, :2], 0.0, atol=1e-7)


def neutral(vehicle):
    """Each body with the mass and the centre of the water that it displaces."""
    data = vehicle.model_dump(mode="json")
    for body in (data["hull"], *data["arm"]["links"]):
        body["volume_m3"] = body["mass_kg"] / data["environment"]["water_density_kg_m3"]
        body["cb_m"] = body["cg_m"]
    return vehicle_from_data(data)


@pytest.mark.parametrize("seed", range(4))
def test_neutral_bodies_move_with_a_uniform_stream(seed):
    """A whole vehicle with its arm at rest in the water stays so, to rounding, however it moves."""
    vehicle = neutral(random_vehicle(seed, 4))
    system, rng = make_system(vehicle, UNIFORM), np.random.default_rng(seed)
    motion = random_motion(rng, 4)
    x = make_state(0.2 * motion.q, vehicle.n_thrusters, position=(0, 0, 5.0), quat=motion.quat)
    idle = np.zeros(vehicle.n_thrusters), np.zeros(4)
    states = simulate(system, x, *idle, 0.005, 2000)
    np.testing.assert_allclose(states[:, VELOCITY:JOINTS], 0.0, atol=1e-12)
    np.testing.assert_allclose(states[:, JOINTS:], np.tile(x[JOINTS:], (2001, 1)), atol=1e-12)
    path = [flow_at(UNIFORM, x[:3], t, GRAVITY).velocity for t in np.linspace(0.0, 10.0, 20001)]
    moved = np.trapezoid(path, dx=0.0005, axis=0)
    np.testing.assert_allclose(states[-1, :3] - x[:3], moved, atol=1e-7)


def particle(current, place, times):
    """Path (k, 3) of a particle of the water."""

    def velocity(t, place):
        return flow_at(current, place, t, GRAVITY).velocity

    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-13, "t_eval": times}
    return solve_ivp(velocity, (times[0], times[-1]), place, **options).y.T


@pytest.mark.parametrize("current", [WAVES, ALL], ids=["waves", "all"])
@pytest.mark.parametrize("damping", [0.0, DAMPING])
def test_a_neutral_body_is_a_particle_of_the_water_in_waves(current, damping):
    """To the integrator's error, which falls with the fourth power of the step, less at a gust."""
    place = np.array([2.0, 1.0, 3.0])
    flow = flow_at(current, place, 0.0, GRAVITY)
    system = make_system(ball(), current)
    to_frame = flow.velocity - surroundings(system, np.array([*place, 0, 0, 0, 1.0]), 0.0).velocity
    errors = []
    for step in (0.05, 0.025, 0.0125):
        start = {"position": place, "nu_r": (*to_frame, 0.0, 0.0, 0.0)}
        times, path, _ = drift(ball(damping=damping), current, 10.0, step, **start)
        errors.append(np.abs(path - particle(current, place, times)).max())
    assert errors[-1] < 1e-8
    assert errors[0] / errors[2] > 4.0**3


def test_a_neutral_body_has_stokes_drift():
    """a^2 omega k cosh(2 k (h - z)) / (2 sinh^2 k h) to the second order (Newman 1977, ch. 6)."""
    wave = WAVE | {"height_m": 0.2, "direction_deg": 0.0}
    h, omega, a, z = 12.0, 2.0 * np.pi / 5.0, 0.1, 3.0
    k = wave_number(5.0, h, GRAVITY)
    current, place = CurrentConfig(waves=[wave]), np.array([0.0, 0.0, z])
    flow = flow_at(current, place, 0.0, GRAVITY)
    start = {"position": place, "nu_r": (*flow.velocity, 0.0, 0.0, 0.0)}
    _, path, _ = drift(ball(), current, 20.0, **start)
    expected = a**2 * omega * k * np.cosh(2.0 * k * (h - z)) / (2.0 * np.sinh(k * h) ** 2)
    assert (path[-1, 0] - path[0, 0]) / 20.0 == pytest.approx(expected, rel=0.03)


def held(vehicle, current, place, time, q=None):
    """Force (6+n,) that holds a level vehicle at rest over ground, and the flow around it."""
    n = vehicle.n_joints
    angles = np.zeros(n) if q is None else q
    system = make_system(vehicle, current)
    x = make_state(angles, vehicle.n_thrusters, position=place)
    around = surroundings(system, x, time)
    still, back = np.zeros(3), np.zeros(n)
    nu_r = np.concatenate([-around.velocity, still])
    nu_r_dot = np.concatenate([-around.acceleration, still])
    motion = nu_r, nu_r_dot, angles, back, back
    return inverse_dynamics_in(system.model, around.wet, around.down, *motion), system, x


@pytest.mark.parametrize("mass", [0.6 * DISPLACED, DISPLACED, 1.7 * DISPLACED])
def test_a_sphere_in_an_accelerating_stream_feels_one_and_a_half_times_its_water(mass):
    """(1 + C_m) rho V A with C_m = 1/2, whatever it weighs (Newman 1977, ch. 4)."""
    for time in (0.3, 1.0, 2.2):
        force, _, _ = held(ball(mass), CurrentConfig(oscillating=[OSCILLATING]), (0, 0, 9.0), time)
        rate = flow_at(CurrentConfig(oscillating=[OSCILLATING]), np.zeros(3), time, GRAVITY).rate
        np.testing.assert_allclose(force[:2], -1.5 * DISPLACED * rate[:2], rtol=1e-9)
        assert force[2] == pytest.approx((DISPLACED - mass) * GRAVITY, abs=1e-6)


def test_a_held_hull_in_waves_feels_morison_s_force():
    """(rho V + m_a) Du/Dt + d |u| u along the waves (Morison et al. 1950), over a whole period."""
    data = ball().model_dump(mode="json")
    data["hull"]["quadratic_damping"] = [60.0, 60.0, 60.0, 0.0, 0.0, 0.0]
    vehicle, place = vehicle_from_data(data), np.array([3.0, -2.0, 4.0])
    current = CurrentConfig(waves=[WAVE | {"direction_deg": 0.0}])
    for time in np.linspace(0.0, 5.0, 9):
        force, _, _ = held(vehicle, current, place, time)
        flow = flow_at(current, place, time, GRAVITY)
        drag = 60.0 * np.abs(flow.velocity) * flow.velocity
        expected = 1.5 * DISPLACED * flow.acceleration + drag
        np.testing.assert_allclose(force[:3], -expected, atol=1e-6)


def test_a_link_far_from_the_hull_feels_the_wave_at_its_own_place():
    """Half a wave away from the hull, in opposite phase: Morison's force of a cylinder there."""
    wave = WAVE | {"direction_deg": 0.0, "height_m": 0.6}
    current, k = CurrentConfig(waves=[wave]), wave_number(5.0, 12.0, GRAVITY)
    away, radius, length = np.pi / k, 0.05, 0.8
    data = ball().model_dump(mode="json")
    data["arm"]["base"] = {"position_m": [away, 0.0, 0.0], "rpy_deg": [0.0, 0.0, 0.0]}
    for joint in data["arm"]["joints"]:
        joint.update(a_m=0.0, d_m=0.0, alpha_deg=0.0, offset_deg=0.0)
    water = DISPLACED / 0.1 * np.pi * radius**2 * length
    cylinder = {
        "center_m": [0.0] * 3, "axis": [0.0, 1.0, 0.0], "radius_m": radius,
        "length_m": length, "stations": 4, "end_effect": 1.0,
    }  # fmt: skip
    data["arm"]["drag_coefficient"].update(cd=[1.0] * len(data["arm"]["drag_coefficient"]["cd"]))
    data["arm"]["links"][0].update(
        volume_m3=np.pi * radius**2 * length, mass_kg=water, drag=[cylinder],
        added_mass=[water, 0.0, water, 0.0, 0.0, 0.0], inertia_kg_m2=[water * length**2 / 12.0] * 3,
    )  # fmt: skip
    vehicle, hull = vehicle_from_data(data), np.array([1.0, 0.0, 3.0])
    for time in np.linspace(0.0, 5.0, 7):
        _, system, x = held(vehicle, current, hull, time)
        around, flow = surroundings(system, x, time), flow_at(current, hull, time, GRAVITY)
        still = np.zeros(6), np.zeros(6), *np.zeros((3, vehicle.n_joints))
        found = coupling_wrench_in(system.model, around.wet, around.tilt, *still)[:3]
        there = flow_at(current, hull + [away, 0.0, 0.0], time, GRAVITY)
        np.testing.assert_allclose(there.velocity, -flow.velocity, atol=1e-12)
        area = 0.5 * 1025.0 * 2.0 * radius * length
        drag = area * np.linalg.norm(there.velocity) * there.velocity
        expected = 2.0 * water * there.acceleration + drag
        np.testing.assert_allclose(found, expected, atol=1e-6)
        np.testing.assert_allclose(around.orbital[:3], flow.velocity, atol=1e-12)


def test_the_reference_vehicle_is_only_moved_about_by_waves():
    """Its arm hanging free, for a minute."""
    current = CurrentConfig(waves=[WAVE], constant_ned_m_s=(0.1, 0.0, 0.0))
    _, path, velocity = drift(REFERENCE, current, 60.0, 0.01, position=(0.0, 0.0, 5.0))
    assert np.isfinite(path).all()
    assert np.abs(velocity).max() < 1.5
