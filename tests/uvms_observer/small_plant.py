"""Vehicle and arm under given thrusts, joint torques and a push, with exact sensors.

The kernels' forward dynamics, thruster lag and Runge-Kutta steps: enough to know what an observer
of wrenches should find. Independent of the plant.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import JointStates, Odometry, Wrench, to_nanoseconds
from uvms_dynamics import build_model, forward_dynamics, joint_passive_torque, mass_matrix
from uvms_dynamics.kernels.rotations import quat_multiply, quat_to_matrix
from uvms_dynamics.model import thruster_matrix

PERIOD = 0.05
SUBSTEPS = 10
NONE = np.zeros((6, 6))


@dataclass
class SmallPlant:
    """State (position, quaternion, nu_r, q, q_dot) and thrusts, advanced one control period a call.

    Args:
        vehicle: what is simulated.
        push: constant wrench on the vehicle, body frame, unknown to the observer.
        current: velocity of the water, map_ned.
    """

    vehicle: object
    push: np.ndarray = None
    current: tuple = (0.0, 0.0, 0.0)

    def __post_init__(self):
        self.model = build_model(self.vehicle)
        n = self.n = self.vehicle.n_joints
        self.x = np.zeros(13 + 2 * n)
        self.x[6] = 1.0
        self.x[7:10] = -np.array(self.current)  # at rest over ground
        self.x[13 : 13 + n] = np.radians(self.vehicle.arm.stowed_deg)
        self.thrust = np.zeros(self.vehicle.n_thrusters)
        self.matrix = thruster_matrix(self.vehicle)
        self.tau = np.array([t.time_constant_s for t in self.vehicle.thrusters])
        self.push = np.zeros(6) if self.push is None else np.array(self.push, dtype=float)
        self.tick = 0
        self.effort = np.zeros(n)  # of the drives over the last period

    @property
    def stamp(self):
        return to_nanoseconds(self.tick * PERIOD)

    def nu(self):
        """Over ground."""
        drift = quat_to_matrix(self.x[3:7]).T @ self.current
        return self.x[7:13] + np.concatenate((drift, np.zeros(3)))

    def odometry(self):
        return Odometry(self.stamp, self.x[:3].copy(), self.x[3:7].copy(), self.nu(), NONE, NONE)

    def joints(self):
        q, q_dot = self.x[13:].reshape(2, self.n).copy()
        return JointStates(self.stamp, q, q_dot, self.effort.copy())

    def step(self, command, effort):
        """One control period under commanded thrusts (m,) and joint torques (n,)."""
        self.effort = np.array(effort)
        h = PERIOD / SUBSTEPS
        for _ in range(SUBSTEPS):
            stages = []
            for share in (0.0, 0.5, 0.5, 1.0):
                past = stages[-1] if stages else np.zeros_like(self.x)
                thrust = command + (self.thrust - command) * np.exp(-share * h / self.tau)
                wrench = self.matrix @ thrust + self.push
                stages.append(self._slope(self.x + share * h * past, wrench, effort))
            a, b, c, d = stages
            self.x = self.x + h / 6.0 * (a + 2.0 * b + 2.0 * c + d)
            self.x[3:7] /= np.linalg.norm(self.x[3:7])
            self.thrust = command + (self.thrust - command) * np.exp(-h / self.tau)
        self.tick += 1

    def _slope(self, x, wrench, effort):
        quaternion, nu, (q, q_dot) = x[3:7], x[7:13], x[13:].reshape(2, self.n)
        tau = np.concatenate((wrench, effort + joint_passive_torque(self.model, q, q_dot)))
        acceleration = forward_dynamics(self.model, quaternion, nu, q, q_dot, tau)
        spin = 0.5 * quat_multiply(quaternion, np.append(nu[3:], 0.0))
        velocity = quat_to_matrix(quaternion) @ nu[:3] + self.current
        return np.concatenate((velocity, spin, acceleration[:6], q_dot, acceleration[6:]))


def steered(plant, goal=None):
    """Thrusts and torques of a plain proportional-derivative law, and the wrench they make.

    The vehicle is held about its start; the joints are drawn to `goal` (n,) rad.
    """
    turn = 2.0 * plant.x[3:6]
    away = np.concatenate((quat_to_matrix(plant.x[3:7]).T @ plant.x[:3], turn))
    wrench = -np.array([60, 60, 60, 5, 60, 40]) * away
    wrench -= np.array([120, 200, 200, 5, 80, 60]) * plant.nu()
    thrust = np.linalg.pinv(plant.matrix) @ wrench
    q, q_dot = plant.x[13:].reshape(2, plant.n)
    goal = np.radians(plant.vehicle.arm.stowed_deg) if goal is None else goal
    inertia = mass_matrix(plant.model, q).diagonal()[6:]
    effort = inertia * (0.5 * (goal - q) - 1.4 * q_dot)
    return thrust, effort, Wrench(plant.stamp, plant.matrix @ thrust)


def run(plant, observer, duration, goal=None):
    """Budgets and totals of every tick, the plant under `steered`."""
    results, achieved = [], None
    for _ in range(round(duration / PERIOD)):
        results.append(observer.step(plant.odometry(), plant.joints(), achieved))
        thrust, effort, achieved = steered(plant, goal)
        plant.step(thrust, effort)
    return results
