"""What events have made of the plant's system: a load, faults of thrusters and joints, pushes.

Where a velocity changes at once, momentum is conserved. The generalised momentum is M v with the
velocity v = (nu_r, q_dot) of hull and joints. A load that is grasped was at rest over ground, and
moves with the last link from then on, without slip and without rebound; the drives give no impulse:

    M_after v_after = M_before v_before + (M_after - M_before) u,    u = (-R^T v_c, 0, 0),

since (M_after - M_before) u is the momentum of the load with the velocity u, that of the ground
through the water. A load that is released goes on with the velocity that it has: nothing changes.
A joint that sticks loses its velocity, and the other coordinates keep their momentum.
"""

from collections.abc import Callable

import numpy as np

from uvms_core.errors import ConfigError
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels import mass_matrix
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.events.load import Load, loaded
from uvms_dynamics.simulation.integrator import (
    JOINTS,
    NO_PUSH,
    QUATERNION,
    VELOCITY,
    System,
    with_vehicle,
)
from uvms_dynamics.simulation.plant.brakes import Brakes, Flags, lock
from uvms_dynamics.simulation.thrusters import SHARE, STUCK


class EventEffects:
    """The system of a plant under its events; see `events.Effects`.

    Args:
        vehicle: as the plant has it.
        drift: tells the present velocity (3,) of the water's frame over ground, in the world.
        system: of the vehicle without events.
        state: of the integrator (nx,), which grasps and stuck joints change.
        brakes: go on with the system as it is.
        step: of the integrator, ns.

    Attributes:
        system: the vehicle with its load.
        moving: the same with stuck joints held, as it is integrated.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        drift: Callable[[], Array],
        system: System,
        state: Array,
        brakes: Brakes,
        step: int,
    ) -> None:
        self._vehicle, self._drift = vehicle, drift
        self._state, self._brakes = state, brakes
        self.step = step
        self._whole = system.thrusters[:, SHARE].copy()
        self._stuck: Flags = np.zeros(vehicle.n_joints, dtype=np.bool_)
        self._pushes: list[Array] = []
        self._load: Load | None = None
        self._has_power = True
        self.system = self.moving = system

    @property
    def push_wrench(self) -> Array | None:
        """Sum (12,) of the pushes that act; None where there are none."""
        return np.sum(self._pushes, axis=0) if self._pushes else None

    @property
    def holds(self) -> bool:
        """Whether the arm holds a load."""
        return self._load is not None

    def grasp(self, load: Load) -> None:
        """The last link holds a load; ConfigError where it holds one already."""
        if self._load is not None:
            raise ConfigError("payload: the arm holds a payload already; release it first")
        before = self._mass_matrix()
        self._load = load
        self._use(loaded(self._vehicle, load))
        added = self._mass_matrix() - before
        self._set_momentum(before @ self._velocity + added @ self._ground())

    def release(self) -> None:
        """The last link lets go; ConfigError where it holds nothing."""
        if self._load is None:
            raise ConfigError("payload: the arm holds no payload")
        self._load = None
        self._use(self._vehicle)

    def set_thruster(self, name: str, share: float, stuck: float) -> None:
        """Thrust is `share` of what a whole thruster makes of its command, plus `stuck`, N."""
        if not self._has_power:
            return
        i = self._vehicle.thruster_names.index(name)
        self.system.thrusters[i, SHARE] = share * self._whole[i]
        self.system.thrusters[i, STUCK] = stuck

    def cut_power(self) -> None:
        """No thruster gives thrust any more, whatever is commanded or stuck; with its lag."""
        self._has_power = False
        self.system.thrusters[:, [SHARE, STUCK]] = 0.0

    def set_joint(self, name: str, stuck: bool) -> None:
        """The joint stops at once and keeps its angle, or moves again."""
        momentum = self._mass_matrix() @ self._velocity
        self._stuck[self._vehicle.joint_names.index(name)] = stuck
        self._settle()
        if stuck:
            self._set_momentum(momentum)

    def push(self, wrench: Array) -> None:
        """A wrench (12,) acts besides the others."""
        self._pushes.append(wrench)
        self._use_pushes()

    def stop_pushing(self, wrench: Array) -> None:
        """One of them acts no more."""
        k = next(k for k, each in enumerate(self._pushes) if np.array_equal(each, wrench))
        del self._pushes[k]
        self._use_pushes()

    def _use_pushes(self) -> None:
        total = self.push_wrench
        self.system = self.system._replace(push=NO_PUSH if total is None else total)
        self._settle()

    def _use(self, vehicle: Vehicle) -> None:
        self.system = with_vehicle(self.system, vehicle)
        self._settle()

    def _settle(self) -> None:
        self.moving = lock(self.system, self._stuck) if self._stuck.any() else self.system
        self._brakes.change(self.system, self._stuck)

    @property
    def _velocity(self) -> Array:
        """(6+n,) of hull and joints."""
        n = self._vehicle.n_joints
        q_dot = self._state[JOINTS + n : JOINTS + 2 * n]
        return np.concatenate([self._state[VELOCITY:JOINTS], q_dot])

    def _ground(self) -> Array:
        """Velocity (6+n,) with which vehicle and load would be at rest over ground."""
        result = np.zeros(6 + self._vehicle.n_joints)
        rotation = quat_to_matrix(self._state[QUATERNION:VELOCITY])
        result[:3] = -rotation.T @ self._drift()
        return result

    def _mass_matrix(self) -> Array:
        q = self._state[JOINTS : JOINTS + self._vehicle.n_joints]
        return mass_matrix(self.system.model, np.ascontiguousarray(q))

    def _set_momentum(self, momentum: Array) -> None:
        """Velocities with this momentum (6+n,) of the coordinates that are free."""
        n = self._vehicle.n_joints
        free = np.concatenate([np.ones(6, dtype=np.bool_), ~self._stuck])
        velocity = np.zeros(6 + n)
        mass = self._mass_matrix()[np.ix_(free, free)]
        velocity[free] = np.linalg.solve(mass, momentum[free])
        self._state[VELOCITY:JOINTS] = velocity[:6]
        self._state[JOINTS + n : JOINTS + 2 * n] = velocity[6:]
