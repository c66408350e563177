"""What must stay constant, fall, or not depend on the observer, while the plant runs."""

import numpy as np
import pytest
from random_vehicles import REFERENCE, changed, random_motion, random_vehicle

from uvms_dynamics import (
    Plant,
    PlantConfig,
    build_model,
    hull_bias_wrench,
    inverse_dynamics,
    mass_matrix,
    quat_to_matrix,
    thruster_matrix,
)
from uvms_dynamics.integrator import JOINTS, QUATERNION, VELOCITY, System, advance, make_scratch
from uvms_dynamics.thrusters import build_thrusters
from uvms_dynamics.vehicle import vehicle_from_data
from uvms_dynamics.vehicle.frames import arm_frames

CURRENT = np.array([0.3, -0.2, 0.0])


class Run:
    """A vehicle that floats free from a start in motion, without commands."""

    def __init__(self, vehicle, seed, current=(0.0, 0.0, 0.0)):
        self.vehicle, self.n = vehicle, vehicle.n_joints
        self.system = System(build_model(vehicle), build_thrusters(vehicle), np.array(current))
        motion = random_motion(np.random.default_rng(seed), self.n)
        idle = np.zeros(vehicle.n_thrusters)
        self.state = np.concatenate(
            [[1.0, 2.0, 3.0], motion.quat, 0.3 * motion.nu, motion.q, 0.3 * motion.q_dot, idle]
        )

    def go(self, duration, step):
        """States (k+1, nx) at every step."""
        steps = round(duration / step)
        x, states = self.state.copy(), np.empty((steps + 1, len(self.state)))
        scratch = make_scratch(self.system)
        thrust, effort = np.zeros(self.vehicle.n_thrusters), np.zeros(self.n)
        advance(self.system, x, thrust, effort, step, scratch, states, np.empty_like(states))
        return states

    def momentum(self, x):
        """Linear momentum in the world, and angular momentum about the start of the water frame."""
        velocity = self.velocity(x)
        momentum = (mass_matrix(self.system.model, x[JOINTS : JOINTS + self.n]) @ velocity)[:6]
        rotation = quat_to_matrix(x[QUATERNION:VELOCITY])
        linear = rotation @ momentum[:3]
        return linear, rotation @ momentum[3:] + np.cross(x[:3], linear)

    def energy(self, x):
        """Kinetic energy of bodies, water and rotors, and potential energy."""
        q = x[JOINTS : JOINTS + self.n]
        velocity = self.velocity(x)
        kinetic = 0.5 * velocity @ mass_matrix(self.system.model, q) @ velocity
        return kinetic + self.potential(x, q)

    def velocity(self, x):
        return np.concatenate([x[VELOCITY:JOINTS], x[JOINTS + self.n : JOINTS + 2 * self.n]])

    def potential(self, x, q):
        """-m g z of every centre of gravity, + rho V g z of every centre of buoyancy."""
        environment, rotation = self.vehicle.environment, quat_to_matrix(x[QUATERNION:VELOCITY])
        frames = [(np.zeros(3), np.eye(3)), *arm_frames(self.vehicle.arm, q)[1:]]
        total = 0.0
        for body, (p, r) in zip((self.vehicle.hull, *self.vehicle.arm.links), frames, strict=True):
            for mass, centre in (
                (body.mass_kg, body.cg_m),
                (-environment.water_density_kg_m3 * body.volume_m3, body.cb_m),
            ):
                depth = x[2] + (rotation @ (p + r @ np.array(centre)))[2]
                total -= mass * environment.gravity_m_s2 * depth
        return total


@pytest.mark.parametrize("current", [(0.0, 0.0, 0.0), CURRENT])
def test_energy_stays_without_drag(current):
    """Seen from the water, whose frame is inertial; the current is level and does no work."""
    run = Run(changed(REFERENCE, drag=False), seed=3, current=current)
    states = run.go(10.0, 0.005)
    energy = np.array([run.energy(x) for x in states[::20]])
    swap = np.ptp([run.potential(x, x[JOINTS : JOINTS + 4]) for x in states[::20]])
    assert swap > 1.0  # J; the arm swings, energy goes to and fro
    assert np.ptp(energy) < 1e-6 * swap


def test_energy_stays_with_a_full_added_mass_on_every_body():
    run = Run(random_vehicle(8, 3, drag=False), seed=8)
    energy = [run.energy(x) for x in run.go(2.0, 0.001)[::20]]
    assert np.ptp(energy) < 1e-6 * abs(energy[0])


def test_energy_falls_with_drag_and_friction():
    run = Run(REFERENCE, seed=3)
    energy = [run.energy(x) for x in run.go(10.0, 0.005)[::20]]
    assert (np.diff(energy) < 0.0).all()


def test_momentum_stays_without_drag():
    """Neutral: no net force, and no moment about the vertical."""
    run = Run(changed(REFERENCE, drag=False), seed=4)
    start, *rest = [run.momentum(x) for x in run.go(10.0, 0.005)[::50]]
    for linear, angular in rest:
        np.testing.assert_allclose(linear, start[0], atol=1e-6 * np.linalg.norm(start[0]))
        assert angular[2] == pytest.approx(start[1][2], abs=1e-6 * np.linalg.norm(start[1]))


def test_runge_kutta_is_of_fourth_order():
    run = Run(changed(REFERENCE, drag=False), seed=5)
    exact = run.go(1.0, 0.00125)[-1]
    errors = [np.linalg.norm(run.go(1.0, step)[-1] - exact) for step in (0.04, 0.02, 0.01)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 4.0, atol=0.3)


def test_quaternion_stays_unit():
    states = Run(REFERENCE, seed=6).go(20.0, 0.005)
    norms = np.linalg.norm(states[:, QUATERNION:VELOCITY], axis=1)
    np.testing.assert_allclose(norms, 1.0, atol=1e-14)


@pytest.mark.parametrize(("seed", "n"), [(21, 1), (22, 3), (23, 6)])
def test_drag_takes_power_from_every_motion(seed, n):
    wet, smooth = random_vehicle(seed, n), random_vehicle(seed, n, drag=False)
    rng = np.random.default_rng(seed)
    for _ in range(20):
        motion = random_motion(rng, n)
        velocity = np.concatenate([motion.nu, motion.q_dot])
        drag = inverse_dynamics(build_model(wet), *motion)
        drag -= inverse_dynamics(build_model(smooth), *motion)
        assert velocity @ drag > 0.0


def run_in_current(current, nu, steps=40):
    """True odometry and joints after 2 s in a current, with thrust and torque."""
    config = PlantConfig(
        current_ned_m_s=tuple(map(float, current)),
        initial_velocity=tuple(map(float, nu)),
        initial_rpy_deg=(10.0, -20.0, 60.0),
        initial_joints_deg=(20.0, 30.0, 40.0, 50.0),
    )
    plant = Plant(REFERENCE, config, seed=1)
    thrust, effort = plant.safe_thrust(), plant.safe_effort()
    thrust.thrust[:] = [50.0, 10.0, -10.0, 5.0, -5.0, 8.0, 3.0]
    effort.effort[:] = [3.0, 4.0, 2.0, 0.5]
    for _ in range(steps):
        plant.step(thrust, effort)
    return plant.truth()


def test_at_rest_in_moving_water_is_moving_through_still_water():
    rotation = quat_to_matrix(
        Plant(REFERENCE, PlantConfig(initial_rpy_deg=(10.0, -20.0, 60.0)), 1)
        .truth()
        .odometry.quaternion
    )
    against = np.concatenate([-rotation.T @ CURRENT, np.zeros(3)])
    carried = run_in_current(CURRENT, np.zeros(6))
    driven = run_in_current(np.zeros(3), against)
    shift = carried.odometry.position - driven.odometry.position
    np.testing.assert_allclose(shift, 2.0 * CURRENT, atol=1e-11)
    np.testing.assert_allclose(carried.odometry.quaternion, driven.odometry.quaternion, atol=1e-11)
    np.testing.assert_allclose(carried.joints.position, driven.joints.position, atol=1e-11)
    np.testing.assert_allclose(carried.disturbance.coupling, driven.disturbance.coupling, atol=1e-9)


def test_truth_says_what_the_current_does_to_the_hull():
    """At rest and level in a current along x: the hull's own surge resistance."""
    data = REFERENCE.model_dump(mode="json")
    for link in data["arm"]["links"]:  # an arm that weighs nothing to speak of
        link.update(mass_kg=1e-9, volume_m3=1e-12, inertia_kg_m2=[1e-12] * 3, drag=[])
        link["added_mass"] = [0.0] * 6
    data["hull"].update(mass_kg=1025.0 * data["hull"]["volume_m3"], cg_m=[0.0, 0.0, 0.01])
    vehicle = vehicle_from_data(data)
    plant = Plant(vehicle, PlantConfig(current_ned_m_s=(0.5, 0.0, 0.0)), seed=1)
    truth = plant.truth()
    drag = 9.61 * 0.5 + 17.4 * 0.5**2
    np.testing.assert_allclose(truth.disturbance.external[0], drag, rtol=1e-6)
    np.testing.assert_allclose(truth.disturbance.external[1:], 0.0, atol=1e-9)
    np.testing.assert_allclose(truth.odometry.nu, 0.0, atol=1e-15)
    np.testing.assert_allclose(truth.disturbance.restoring, 0.0, atol=1e-6)


def test_no_external_disturbance_in_still_water():
    plant = Plant(REFERENCE, PlantConfig(initial_velocity=(0.5, 0.1, 0, 0, 0.1, 0.2)), seed=1)
    plant.step(plant.safe_thrust(), plant.safe_effort())
    np.testing.assert_array_equal(plant.truth().disturbance.external, np.zeros(6))


def test_truth_budget_explains_the_hulls_motion():
    """M_hull nu_dot + bias of the hull = restoring + coupling + external + thrust, in a current.

    The acceleration comes from two neighbouring ticks, not from the plant's own equations.
    """
    model, step = build_model(REFERENCE), 1e-4
    config = PlantConfig(
        step_s=step,
        control_period_s=step,
        initial_velocity=(0.5, 0.1, 0.0, 0.0, 0.1, 0.2),
        current_ned_m_s=tuple(CURRENT),
    )
    plant = Plant(sensors_at(REFERENCE, 1.0), config, seed=1)
    command = plant.safe_thrust()
    command.thrust[0] = 30.0
    truths = []
    for _ in range(40):
        plant.step(command, plant.safe_effort())
        truths.append(plant.truth())
    before, now, after = truths[-3:]
    nu = now.odometry.nu
    nu_dot = (after.odometry.nu - before.odometry.nu) / (2.0 * step)
    rigid = model.bodies[0, :36].reshape(6, 6)  # with added mass
    needed = rigid @ nu_dot + hull_bias_wrench(model, nu)
    budget = now.disturbance
    given = budget.restoring + budget.coupling + budget.external
    given += thruster_matrix(REFERENCE) @ now.thrust
    np.testing.assert_allclose(given, needed, atol=1e-4 * np.abs(needed).max())


def sensors_at(vehicle, rate):
    """The vehicle with all sensors at one rate, Hz."""
    data = vehicle.model_dump(mode="json")
    for name in ("imu", "dvl", "pressure", "gps"):
        data["sensors"][name]["rate_hz"] = rate
    return vehicle_from_data(data)
