"""A vehicle that floats free from a start in motion, and what it should keep or lose."""

import numpy as np
from random_vehicles import random_motion

from uvms_core.vehicle.frames import arm_frames
from uvms_dynamics import build_model, mass_matrix, quat_to_matrix
from uvms_dynamics.model import thruster_matrix
from uvms_dynamics.simulation.integrator import (
    JOINTS,
    QUATERNION,
    VELOCITY,
    System,
    advance,
    make_scratch,
)
from uvms_dynamics.simulation.thrusters import build_thrusters


class FreeRun:
    """Integrator, start and energies, all as seen from the water, whose frame is inertial."""

    def __init__(self, vehicle, seed, current=(0.0, 0.0, 0.0), rates=0.3):
        self.vehicle, self.n = vehicle, vehicle.n_joints
        self.current = np.array(current, dtype=float)
        self.system = System(build_model(vehicle), build_thrusters(vehicle), self.current)
        self.thrust, self.effort = np.zeros(vehicle.n_thrusters), np.zeros(self.n)
        motion = random_motion(np.random.default_rng(seed), self.n)
        self.state = np.concatenate(
            [[1.0, 2.0, 3.0], motion.quat, rates * motion.nu, motion.q, rates * motion.q_dot]
            + [self.thrust]
        )

    def go(self, duration, step):
        """States (k+1, nx) at every step, under constant thrust and effort."""
        steps = round(duration / step)
        x, states = self.state.copy(), np.empty((steps + 1, len(self.state)))
        scratch = make_scratch(self.system)
        rates = np.empty_like(states)
        advance(self.system, x, self.thrust, self.effort, step, scratch, states, rates, 0.0)
        return states

    def joints(self, x):
        return x[JOINTS : JOINTS + self.n]

    def velocity(self, x):
        """(nu_r, q_dot)."""
        return np.concatenate([x[VELOCITY:JOINTS], x[JOINTS + self.n : JOINTS + 2 * self.n]])

    def momentum(self, x, time=0.0):
        """Linear and angular momentum (6,) of bodies and water, about the water's own origin."""
        momentum = (mass_matrix(self.system.model, self.joints(x)) @ self.velocity(x))[:6]
        rotation = quat_to_matrix(x[QUATERNION:VELOCITY])
        linear = rotation @ momentum[:3]
        lever = x[:3] - self.current * time
        return np.concatenate([linear, rotation @ momentum[3:] + np.cross(lever, linear)])

    def energy(self, x):
        """Kinetic energy of bodies, water and rotors, potential energy, and that of the stops."""
        return self.kinetic(x) + self.potential(x) + self.stored_in_stops(x)

    def kinetic(self, x):
        zeta = self.velocity(x)
        return 0.5 * zeta @ mass_matrix(self.system.model, self.joints(x)) @ zeta

    def potential(self, x):
        """-m g z of every centre of gravity, + rho V g z of every centre of buoyancy."""
        water, rotation = self.vehicle.environment, quat_to_matrix(x[QUATERNION:VELOCITY])
        frames = arm_frames(self.vehicle.arm, self.joints(x))[1:]
        bodies = (self.vehicle.hull, *self.vehicle.arm.links)
        total = 0.0
        for body, (p, r) in zip(bodies, [(np.zeros(3), np.eye(3)), *frames], strict=True):
            for mass, centre in (
                (body.mass_kg, body.cg_m),
                (-water.water_density_kg_m3 * body.volume_m3, body.cb_m),
            ):
                depth = x[2] + (rotation @ (p + r @ np.array(centre)))[2]
                total -= mass * water.gravity_m_s2 * depth
        return total

    def stored_in_stops(self, x):
        total = 0.0
        for joint, angle in zip(self.vehicle.arm.joints, self.joints(x), strict=True):
            low, high = np.radians([joint.lower_deg, joint.upper_deg])
            depth = max(low - angle, angle - high, 0.0)
            total += 0.5 * joint.stop_stiffness_nm_rad * depth**2
        return total

    def power(self, states):
        """Of drives and thrusters on the system (k,), W, in states (k, nx)."""
        n = self.n
        wrench = states[:, JOINTS + 2 * n :] @ thruster_matrix(self.vehicle).T
        of_thrusters = (wrench * states[:, VELOCITY:JOINTS]).sum(axis=1)
        return of_thrusters + states[:, JOINTS + n : JOINTS + 2 * n] @ self.effort
