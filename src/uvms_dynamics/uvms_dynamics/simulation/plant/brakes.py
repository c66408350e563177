"""Brakes of the joints, which engage where there is no command: they hold exactly, or slip.

A brake is dry friction without a width: at rest it takes any torque up to `brake_nm`, beyond that
and in motion it opposes the motion with `brake_nm`. A smooth curve through zero would creep under
every load. So each joint is either held, which takes its degree of freedom out of the equations, or
it slips under a constant torque, and the step ends early where one comes to rest.

A joint is held by a rotor of infinite inertia: the articulated-body algorithm then gives it an
acceleration of exactly zero, and the rest of the vehicle the motion with that joint rigid
(Featherstone 2008, sec. 9.2). Neither can add energy: holding does no work, slipping takes some.
"""

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels import inverse_dynamics, joint_passive_torque
from uvms_dynamics.kernels.inverse import inverse_dynamics_in
from uvms_dynamics.kernels.layout import ROTOR
from uvms_dynamics.simulation.integrator import (
    JOINTS,
    QUATERNION,
    VELOCITY,
    Scratch,
    System,
    advance,
)
from uvms_dynamics.simulation.water.surroundings import surroundings

Flags = NDArray[np.bool_]

_EVENTS_A_JOINT = 4
"""How often a step is cut for a joint that comes to rest; after that all that rest are held."""

_HALVINGS = 40
"""Of the step in search of the instant of rest: to 1e-12 of it, where the rate is rounding."""


def lock(system: System, held: Flags) -> System:
    """The system with some of its joints (n,) held, by a model of its own."""
    model = system.model.copy()
    model[1 : 1 + len(held), ROTOR][held] = np.inf
    return system._replace(model=model)


class Brakes:
    """The brakes of one vehicle; `system` and `scratch` are those of its plant."""

    def __init__(self, vehicle: Vehicle, system: System, scratch: Scratch) -> None:
        self._torque = np.array([joint.brake_nm for joint in vehicle.arm.joints])
        self._n = vehicle.n_joints
        self._scratch = scratch
        self.change(system, np.zeros(self._n, dtype=np.bool_))
        size = scratch.trial.shape[0]
        self._row, self._rate = np.empty((2, size)), np.empty((2, size))
        self._now = 0.0  # s

    def change(self, system: System, stuck: Flags) -> None:
        """Go on with another system, and with joints (n,) that are stuck: those never slip."""
        self._system, self._stuck = system, stuck.copy()
        self._locked = lock(system, stuck)

    @property
    def exist(self) -> bool:
        """Whether any joint has a brake."""
        return bool(self._torque.any())

    def advance(
        self, x: Array, thrust: Array, step: float, states: Array, rates: Array, time: float
    ) -> None:
        """As `integrator.advance` with no drive torque and all brakes engaged.

        x (nx,) becomes the state at the end, rows of states and rates (steps+1, nx) those after
        each step of `step` s; thrust (m,) N; x begins at `time`, s.
        """
        self._now = time
        effort, rate = self._engage(x, thrust, may_slip=True)
        states[0], rates[0] = x, rate
        for k in range(1, len(states)):
            effort, rate = self._step(x, thrust, effort, step)
            states[k], rates[k] = x, rate

    def _step(self, x: Array, thrust: Array, effort: Array, step: float) -> tuple[Array, Array]:
        """One step, in pieces that end where a joint comes to rest; what `_engage` says then."""
        events = _EVENTS_A_JOINT * self._n
        while True:
            done = self._until_rest(x, thrust, effort, step)
            step, self._now = step - done, self._now + done
            events -= 1
            effort, rate = self._engage(x, thrust, may_slip=step <= 0.0 or events > 0)
            if step <= 0.0:
                return effort, rate

    def _engage(self, x: Array, thrust: Array, may_slip: bool) -> tuple[Array, Array]:
        """Torque (n,) of the slipping brakes, and the rate (nx,) of the state with them.

        The joints that are held are locked. Of the joints at rest the one that is overloaded most
        begins to slip first, because that changes the load of the others.
        """
        q_dot = x[JOINTS + self._n : JOINTS + 2 * self._n]
        effort = -np.sign(q_dot) * self._torque
        held = (q_dot == 0.0) & (self._torque > 0.0) & ~self._stuck
        self._lock(held)
        rate = self._derivative(x, thrust, effort)
        while may_slip and held.any():
            load = self._load(x, rate)
            excess = np.where(held, np.abs(load) - self._torque, -1.0)
            worst = int(np.argmax(excess))
            if not excess[worst] > 0.0:
                break
            held[worst] = False
            effort[worst] = np.sign(load[worst]) * self._torque[worst]
            self._lock(held)
            rate = self._derivative(x, thrust, effort)
        return effort, rate

    def _lock(self, held: Flags) -> None:
        rows = slice(1, 1 + self._n)
        rotor = self._system.model[rows, ROTOR]
        self._locked.model[rows, ROTOR] = np.where(held | self._stuck, np.inf, rotor)

    def _load(self, x: Array, rate: Array) -> Array:
        """Torque (n,) that each joint needs for its motion besides friction and stops.

        What a brake must take where it holds.
        """
        n, model = self._n, self._system.model
        q, q_dot = x[JOINTS : JOINTS + n], x[JOINTS + n : JOINTS + 2 * n]
        quat = x[QUATERNION:VELOCITY] / np.linalg.norm(x[QUATERNION:VELOCITY])
        nu_dot, q_ddot = rate[VELOCITY:JOINTS], rate[JOINTS + n : JOINTS + 2 * n]
        motion = x[VELOCITY:JOINTS], nu_dot, q, q_dot, q_ddot
        if (moving := surroundings(self._system, x, self._now)) is None:
            needed = inverse_dynamics(model, quat, *motion)
        else:
            needed = inverse_dynamics_in(model, moving.wet, moving.down, *motion)
        return needed[6:] - joint_passive_torque(model, q, q_dot)

    def _derivative(self, x: Array, thrust: Array, effort: Array) -> Array:
        self._integrate(x, thrust, effort, 0.0, steps=0)
        return self._rate[0].copy()

    def _until_rest(self, x: Array, thrust: Array, effort: Array, step: float) -> float:
        """Advance to the end of the step, or to where the first joint comes to rest; s."""
        start, past = x.copy(), step
        if not self._try(x, start, thrust, effort, step).any():
            return step
        before = 0.0
        for _ in range(_HALVINGS):
            middle = 0.5 * (before + past)
            if self._try(x, start, thrust, effort, middle).any():
                past = middle
            else:
                before = middle
        rest = self._try(x, start, thrust, effort, past)
        x[JOINTS + self._n : JOINTS + 2 * self._n][rest] = 0.0
        return past

    def _try(self, x: Array, start: Array, thrust: Array, effort: Array, step: float) -> Flags:
        """Set x to the state a step after the start; which joints (n,) have turned back by then."""
        x[:] = start
        self._integrate(x, thrust, effort, step, steps=1)
        turned_back: Flags = x[JOINTS + self._n : JOINTS + 2 * self._n] * effort > 0.0
        return turned_back

    def _integrate(self, x: Array, thrust: Array, effort: Array, step: float, steps: int) -> None:
        tables = self._scratch, self._row[: steps + 1], self._rate[: steps + 1]
        advance(self._locked, x, thrust, effort, step, *tables, self._now)
