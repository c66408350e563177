"""The plant in water that moves: its truth, sensors, brakes and start, and what it refuses."""

import math

import numpy as np
import pytest
from random_vehicles import REFERENCE
from test_current import sensors_at
from test_flow import ALL, GRAVITY, GUST, OSCILLATING, TURNING, WAVES
from water_bodies import ball

from uvms_core.config import validated
from uvms_core.errors import ConfigError
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import build_model, hull_bias_wrench, quat_to_matrix, thruster_matrix
from uvms_dynamics.numpy_reference import body_inertia, moving_water
from uvms_dynamics.numpy_reference.flow import flow_at
from uvms_dynamics.simulation import (
    Plant,
    PlantConfig,
    advance_batch,
    make_state,
    make_system,
    simulate,
)
from uvms_dynamics.simulation.integrator import advance, make_scratch, with_vehicle
from uvms_dynamics.simulation.plant.operating_points import operating_points
from uvms_dynamics.simulation.water import CurrentConfig
from uvms_dynamics.simulation.water.tables import greatest_speed

STEP = 1e-4
BLOW = CurrentConfig(
    gusts=[GUST | {"at_s": 0.2, "duration_s": 1.6, "rise_s": 0.5}], waves=[WAVES[0]]
)
START = {"initial_velocity": (0.5, 0.1, 0.0, 0.0, 0.1, 0.2), "initial_position_m": (3.0, 2.0, 5.0)}
EARLY = ALL.model_copy(
    update={"gusts": tuple(g.model_copy(update={"at_s": 0.0}) for g in ALL.gusts)}
)
"""All kinds of flow, with gusts that rise at once."""


def exact(vehicle, **sensors):
    """The vehicle with sensors that have no error, each sampled at 1 kHz."""
    data = vehicle.model_dump(mode="json")
    for section in (data["sensors"][name] for name in ("imu", "dvl", "pressure")):
        section["rate_hz"] = 1000.0
        for field in section:
            if any(word in field for word in ("noise", "bias_", "scale_error")):
                section[field] = 1.0 if "time_constant" in field else 0.0
        section.update(sensors)
    data["sensors"]["gps"]["rate_hz"] = 1000.0
    return vehicle_from_data(data)


def test_truth_budget_explains_the_hulls_motion():
    """M_hull nu_dot + bias of the hull = restoring + coupling + external + thrust, in all flows.

    The acceleration comes from two neighbouring ticks, not from the plant's own equations.
    """
    model = build_model(REFERENCE)
    config = PlantConfig(step_s=STEP, control_period_s=STEP, current=EARLY, **START)
    plant = Plant(sensors_at(REFERENCE, 1.0), config, seed=1)
    command = ThrusterCommand(0, np.zeros(REFERENCE.n_thrusters))
    command.thrust[0] = 30.0
    truths = []
    for _ in range(40):
        plant.step(command, None)
        truths.append(plant.truth())
    before, now, after = truths[-3:]
    nu = now.odometry.nu
    nu_dot = (after.odometry.nu - before.odometry.nu) / (2.0 * STEP)
    needed = body_inertia(REFERENCE.hull) @ nu_dot + hull_bias_wrench(model, nu)
    budget = now.disturbance
    given = budget.restoring + budget.coupling + budget.external
    given += thruster_matrix(REFERENCE) @ now.thrust
    np.testing.assert_allclose(given, needed, atol=1e-4 * np.abs(needed).max())


def test_truth_is_over_ground_and_says_how_the_water_moves():
    """Velocity is the rate of the position; the water's is at the hull's centre of buoyancy."""
    config = PlantConfig(step_s=STEP, control_period_s=STEP, current=EARLY, **START)
    plant = Plant(sensors_at(REFERENCE, 1.0), config, seed=1)
    np.testing.assert_allclose(plant.truth().odometry.nu, START["initial_velocity"], atol=1e-15)
    truths = []
    for _ in range(30):
        plant.step(None, None)
        truths.append(plant.truth())
    before, now, after = (truth.odometry for truth in truths[-3:])
    rotation = quat_to_matrix(now.quaternion)
    speed = (after.position - before.position) / (2.0 * STEP)
    np.testing.assert_allclose(rotation @ now.nu[:3], speed, atol=1e-6)
    centre = now.position + rotation @ np.array(REFERENCE.hull.cb_m)
    water = flow_at(EARLY, centre, 29 * STEP, GRAVITY).velocity
    np.testing.assert_allclose(truths[-2].water, water, atol=1e-12)


@pytest.mark.parametrize("mass", [700.0, 1025.0])
def test_sensors_feel_the_accelerated_water(mass):
    """Specific force and velocity at the lever arms, against differences of the true position."""
    vehicle = exact(ball(0.1 * mass, 30.0), position_m=[0.3, -0.2, 0.1])
    period = 1e-3
    config = PlantConfig(step_s=period, control_period_s=period, current=EARLY, **START)
    plant, places, frames, truths = Plant(vehicle, config, seed=1), [], [], []
    for _ in range(600):
        plant.step(None, None)
        truth = plant.truth().odometry
        rotation = quat_to_matrix(truth.quaternion)
        places.append(truth.position + rotation @ [0.3, -0.2, 0.1])
        frames.append(plant.sense())
        truths.append(truth)
    for k in (50, 300, 560):
        rotation = quat_to_matrix(truths[k].quaternion)
        speed = (places[k + 1] - places[k - 1]) / (2.0 * period)
        rate = (places[k + 1] - 2.0 * places[k] + places[k - 1]) / period**2
        force = rotation.T @ (rate - [0.0, 0.0, GRAVITY])
        np.testing.assert_allclose(frames[k].dvl[0].velocity, rotation.T @ speed, atol=1e-5)
        np.testing.assert_allclose(frames[k].imu[0].linear_acceleration, force, atol=2e-5)


def test_pressure_has_that_of_the_waves():
    """Hydrostatic, with a g cosh k (h - z) / cosh k h cos(omega t) above the origin at a crest."""
    wave = {"height_m": 1.0, "period_s": 8.0, "water_depth_m": 20.0}
    config = PlantConfig(
        step_s=0.001,
        control_period_s=0.001,
        current={"waves": [wave]},
        initial_position_m=(0, 0, 6),
    )
    vehicle = exact(ball(), position_m=[0.0, 0.0, 0.5])
    sample = Plant(vehicle, config, seed=1).sense().pressure[0]
    omega = 2.0 * math.pi / 8.0
    lengths = np.linspace(0.01, 1.0, 1_000_001)
    k = lengths[np.argmin(np.abs(GRAVITY * lengths * np.tanh(20.0 * lengths) - omega**2))]
    head = 0.5 * math.cosh(k * (20.0 - 6.5)) / math.cosh(k * 20.0)
    sea = vehicle.environment
    expected = sea.water_density_kg_m3 * GRAVITY * (6.5 + head)
    assert sample.pressure - sea.atmospheric_pressure_pa == pytest.approx(expected, rel=1e-6)


def braked(brakes):
    """Truths of two seconds in a blow and waves, in steps of a control period, brakes engaged."""
    data = REFERENCE.model_dump(mode="json")
    for joint, brake in zip(data["arm"]["joints"], brakes, strict=True):
        joint["brake_nm"] = float(brake)
    posture = {"initial_joints_deg": (0.0, 45.0, 45.0, 0.0), "initial_position_m": (0, 0, 4)}
    pace = {"step_s": 0.005, "control_period_s": 0.005}
    plant = Plant(
        sensors_at(vehicle_from_data(data), 1.0), PlantConfig(current=BLOW, **posture, **pace), 1
    )
    truths = []
    for _ in range(400):
        plant.step(None, None)
        truths.append(plant.truth())
    return truths


def test_a_brake_holds_up_to_its_torque_in_moving_water():
    """What it must take is the torque of the numpy reference at the motion that it then has."""
    truths, loads = braked([1e3] * 4), []
    still = np.zeros(4)
    for k in range(1, len(truths) - 1):
        before, now, after = (truth.odometry for truth in truths[k - 1 : k + 2])

        def flow(place, k=k):
            return flow_at(BLOW, place, 0.005 * (k + 1), GRAVITY)

        nu_dot = (after.nu - before.nu) / 0.01
        motion = now.nu, nu_dot, truths[k].joints.position, still, still
        force = moving_water.inverse_dynamics(
            REFERENCE, flow, now.position, now.quaternion, *motion
        )
        loads.append(np.abs(force[6:]))
    peaks, joint = np.max(loads, axis=0), int(np.argmax(np.max(loads, axis=0)))
    for share, holds in ((1.01, True), (0.99, False)):
        brakes = np.full(4, 1e3)
        brakes[joint] = share * peaks[joint]
        found = braked(brakes)
        moved = [truth.joints.position for truth in found] - truths[0].joints.position
        assert np.any(moved[:, joint]) != holds
        assert not np.any(np.delete(moved, joint, axis=1))


def test_the_short_name_of_the_constant_current_is_the_same():
    short = PlantConfig(current_ned_m_s=(0.3, -0.2, 0.1), **START)
    long = PlantConfig(current={"constant_ned_m_s": (0.3, -0.2, 0.1)}, **START)
    thrust = ThrusterCommand(0, np.full(REFERENCE.n_thrusters, 3.0))
    plants = [Plant(REFERENCE, config, seed=1) for config in (short, long)]
    for plant in plants:
        for _ in range(10):
            plant.step(thrust, JointCommand(0, np.full(4, 0.1)))
    first, second = (plant.truth() for plant in plants)
    np.testing.assert_array_equal(first.odometry.position, second.odometry.position)
    np.testing.assert_array_equal(first.disturbance.external, second.disturbance.external)
    np.testing.assert_array_equal(second.water, [0.3, -0.2, 0.1])


def test_a_flow_that_hardly_moves_is_the_constant_current():
    """The code for moving water in the limit of none: the same run to rounding."""
    none = {"oscillating": [OSCILLATING | {"amplitude_m_s": 0.0}]}
    ripple = {"waves": [{"height_m": 1e-300, "period_s": 8.0, "water_depth_m": 50.0}]}
    thrust = ThrusterCommand(0, np.full(REFERENCE.n_thrusters, 3.0))
    found = []
    for current in ({}, none, ripple):
        constant = {"constant_ned_m_s": (0.3, -0.2, 0.1)}
        plant = Plant(REFERENCE, PlantConfig(current=constant | current, **START), seed=1)
        for _ in range(20):
            plant.step(thrust, None)
        truth = plant.truth()
        found.append([*truth.odometry.position, *truth.odometry.nu, *truth.joints.position])
    np.testing.assert_allclose(found[1], found[0], atol=1e-13)
    np.testing.assert_allclose(found[2], found[0], atol=1e-13)


def test_the_step_is_checked_in_the_fastest_water():
    config = PlantConfig(current=ALL)
    points = operating_points(REFERENCE, build_model(REFERENCE), config)
    names = [point.name for point in points if "in water" in point.name]
    speed = greatest_speed(ALL)
    assert names == [f"in water of {speed:.3g} m/s along {k}" for k in ("surge", "sway", "heave")]
    rng = np.random.default_rng(1)
    places = rng.uniform([-50.0, -50.0, 0.0, 0.0], [50.0, 50.0, 15.0, 20.0], (2000, 4))
    met = [flow_at(ALL, place[:3], place[3], GRAVITY).velocity for place in places]
    assert np.linalg.norm(met, axis=1).max() <= speed
    drag = REFERENCE.model_dump(mode="json")
    drag["hull"]["quadratic_damping"] = [17.4, 4e5, 160.0, 1.0, 80.0, 80.0]
    gusty = {"gusts": [GUST | {"velocity_ned_m_s": [0.0, 3.0, 0.0]}]}
    Plant(vehicle_from_data(drag), PlantConfig(), seed=1)
    with pytest.raises(ConfigError, match=r"damping of the hull in sway.* in water of 3 m/s along"):
        Plant(vehicle_from_data(drag), PlantConfig(current=gusty), seed=1)


def test_a_simulation_goes_on_where_another_ended():
    system = make_system(REFERENCE, ALL)
    x = make_state(np.zeros(4), REFERENCE.n_thrusters, position=(0.0, 0.0, 5.0))
    idle = np.zeros(REFERENCE.n_thrusters), np.zeros(4)
    whole = simulate(system, x, *idle, 0.01, 400)
    first = simulate(system, x, *idle, 0.01, 150)
    then = simulate(system, first[-1], *idle, 0.01, 250, start_s=1.5)
    np.testing.assert_allclose(then, whole[150:], atol=1e-10)
    with pytest.raises(ConfigError, match="its water moves; advance_batch knows constant"):
        advance_batch(system, x[None], idle[0][None], idle[1][None], 0.01, 1)


def test_a_vehicle_that_changes_in_waves_is_another_vehicle():
    """As with a load: the old scratch tables, the new bodies."""
    data = REFERENCE.model_dump(mode="json")
    data["arm"]["links"][-1].update(mass_kg=4.0, volume_m3=0.003)
    data["hull"]["volume_m3"] *= 1.01
    heavier, system = vehicle_from_data(data), make_system(REFERENCE, ALL)
    x = make_state(np.full(4, 0.4), REFERENCE.n_thrusters, position=(0.0, 0.0, 5.0))
    scratch, states = make_scratch(system), np.empty((51, len(x)))
    thrust, effort = np.zeros(REFERENCE.n_thrusters), np.zeros(4)
    other = with_vehicle(system, heavier)
    advance(other, x.copy(), thrust, effort, 0.01, scratch, states, states.copy(), 2.0)
    fresh = simulate(make_system(heavier, ALL), x, thrust, effort, 0.01, 50, start_s=2.0)
    np.testing.assert_array_equal(states, fresh)
    np.testing.assert_array_equal(other.water.hull, make_system(heavier, ALL).water.hull)


WAVE = WAVES[0]


@pytest.mark.parametrize(
    ("current", "message"),
    [
        ({"gusts": [GUST | {"rise_s": 3.0}]}, r"rise_s: 3 s does not fit twice.*at most 2.5 s"),
        ({"gusts": [GUST | {"rise_s": 0.0}]}, r"gusts.0.rise_s: .*greater than or equal to 0.1"),
        ({"gusts": [GUST | {"at_s": -1.0}]}, r"gusts.0.at_s: .*greater than or equal to 0"),
        (
            {"turning": TURNING | {"period_s": 0.0}},
            r"turning.period_s: .*greater than or equal to 1",
        ),
        (
            {"oscillating": [OSCILLATING | {"period_s": -8}]},
            r"oscillating.0.period_s: .*equal to 1",
        ),
        ({"oscillating": [OSCILLATING | {"amplitude_m_s": 101}]}, "amplitude_m_s: .*equal to 100"),
        ({"waves": [WAVE | {"period_s": 0.5}]}, r"waves.0.period_s: .*greater than or equal to 1"),
        ({"waves": [WAVE | {"height_m": 9.0}]}, r"a wave of 9 m breaks: .*and at most 7.11 m high"),
        ({"waves": [WAVE | {"height_m": -1.0}]}, r"height_m: .*greater than or equal to 0"),
        ({"waves": [WAVE, WAVE | {"water_depth_m": 20}]}, r"waves.1.water_depth_m: 20 m, but 15 m"),
        ({"waves": [WAVE | {"water_depth_m": 8.0}]}, r"waves.0.water_depth_m: 8 m is not below"),
        (
            {"constant_ned_m_s": [0.0, 101.0, 0.0]},
            r"constant_ned_m_s.1: .*less than or equal to 100",
        ),
        ({"swell": []}, "swell.*known names here: constant_ned_m_s, gusts, oscillating, turning"),
    ],
)
def test_what_is_refused(current, message):
    with pytest.raises(ConfigError, match=message):
        validated(PlantConfig, {"current": current}, "plant")


def test_two_constant_currents_are_refused():
    both = {"current_ned_m_s": [0.1, 0, 0], "current": {"constant_ned_m_s": [0.1, 0, 0]}}
    with pytest.raises(
        ConfigError, match=r"a short name of current\.constant_ned_m_s: give only one"
    ):
        validated(PlantConfig, both, "plant")
