"""The velocity through the water that the thrusts give: a model of the hull, carried along.

    M v_r' + C(nu_r) nu_r + D(nu_r) nu_r + g(R) = tau

for the three axes along which the vehicle moves (Fossen 2011, chapter 8); its turning is measured
and is an input. The arm is taken to be stowed and at rest. Thrusts are those of the allocator, with
the thrusters' lag. What the control does is kept by stamp, and worked out only where somebody asks,
so that it costs nothing while a sensor tells the velocity, and that a filter that goes back in time
finds there what it found before.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Allocation, Array, Odometry, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model, inverse_dynamics, mass_matrix, thruster_matrix
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_observer.lagged_thrusts import LaggedThrusts

MEMORY = to_nanoseconds(30.0)
"""How long intervals are kept, ns: by then a hull has forgotten the velocity that it began with."""
SETTLED = to_nanoseconds(10.0)
"""How long the thrusts must have been known before the model counts, ns."""
HOLDS = to_nanoseconds(0.2)
"""For how long a thrust stands in for those that are missing, ns: as control itself goes on."""
BROKEN = 0.5
"""Share of its command below which a thruster is not known any more, nor what the hull does."""
LONGEST = 0.05
"""Of a step of the integration, s."""


class Interval(NamedTuple):
    """What the control did between two ticks."""

    begin: int  # ns
    end: int  # ns
    told: Allocation | None  # what was commanded at its beginning, or the newest before
    before: Odometry  # the estimate at its beginning


class ModelVelocity(NamedTuple):
    """What the model says at a stamp."""

    stamp: int  # ns
    velocity: Array  # (3,) m/s, of the body origin through the water, body axes
    rate: Array  # (3,) rad/s


class HullMotion:
    """The model of a vehicle, fed with thrusts; several estimators may ask it.

    Args:
        vehicle: masses, water, thrusters.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        self._model = build_model(vehicle)
        self._q = np.radians(vehicle.arm.stowed_deg)
        mass = mass_matrix(self._model, self._q)[:3, :3]
        self._inverse_mass = np.ascontiguousarray(np.linalg.inv(mass))
        self._matrix = thruster_matrix(vehicle)
        self._vehicle = vehicle
        self._told: Allocation | None = None
        self._held: tuple[int, Array] | None = None
        self._intervals: deque[Interval] = deque()
        self._track: deque[ModelVelocity] = deque()
        self._since = 0  # ns, when the track has begun
        self._lag = LaggedThrusts(vehicle)

    def inform(self, allocation: Allocation | None) -> None:
        """The thrusts over the interval that the next step ends; None: not known."""
        self._told = allocation

    def note(self, stamp: int, before: Odometry) -> None:
        """An interval that ends at `stamp` (ns), and the estimate at its beginning."""
        told, self._told = self._told, None
        if told is None and not self._intervals:
            return
        self._intervals.append(Interval(before.stamp, stamp, told, before))
        if self._intervals[0].end < stamp - MEMORY:
            self._intervals.popleft()

    def _thrust(self, interval: Interval) -> Array | None:
        """(m,) N, commanded over an interval; None: not known."""
        told = interval.told
        if told is not None and len(told.thrust) == self._matrix.shape[1]:
            share = told.effectiveness if len(told.effectiveness) else np.ones(len(told.thrust))
            works = bool((share >= BROKEN).all())
            self._held = (told.stamp, share * told.thrust) if works else None
        held = self._held
        return held[1] if held is not None and 0 <= interval.begin - held[0] <= HOLDS else None

    def at(self, stamp: int) -> ModelVelocity | None:
        """What the model says at a stamp (ns); None where the thrusts have not been known."""
        self._carry_on()
        track = self._track
        if len(track) < 2 or not track[0].stamp <= stamp <= track[-1].stamp:
            return None
        if stamp - self._since < SETTLED:
            return None
        k = len(track) - 1
        while track[k - 1].stamp > stamp:
            k -= 1
        a, b = track[k - 1], track[k]
        share = (stamp - a.stamp) / (b.stamp - a.stamp)
        return ModelVelocity(
            stamp,
            a.velocity + share * (b.velocity - a.velocity),
            a.rate + share * (b.rate - a.rate),
        )

    def _carry_on(self) -> None:
        """Through the intervals that have come since."""
        fresh = []
        for each in reversed(self._intervals):
            if self._track and each.end <= self._track[-1].stamp:
                break
            fresh.append(each)
        for each in reversed(fresh):
            self._through(each)
        while self._track and self._track[0].stamp < self._track[-1].stamp - MEMORY:
            self._track.popleft()

    def _through(self, interval: Interval) -> None:
        commanded = self._thrust(interval)
        if commanded is None:
            self._track.clear()
            return
        now = interval.before
        if not self._track or self._track[-1].stamp != interval.begin:
            self._track.clear()
            self._since = interval.begin
            self._lag = LaggedThrusts(self._vehicle)
            self._lag.step(10.0, commanded)
            self._track.append(ModelVelocity(interval.begin, now.nu[:3].copy(), now.nu[3:]))
        dt = to_seconds(interval.end - interval.begin)
        thrust = self._lag.step(dt, commanded)
        velocity = through_water(
            self._model,
            self._inverse_mass,
            now.quaternion,
            now.nu[3:],
            self._track[-1].velocity,
            self._matrix[:3] @ thrust,
            self._q,
            dt,
        )
        self._track.append(ModelVelocity(interval.end, velocity, now.nu[3:]))


@exact_kernel
def through_water(
    model: Array,
    inverse_mass: Array,
    quat: Array,
    rate: Array,
    velocity: Array,
    force: Array,
    q: Array,
    dt: float,
) -> Array:
    """Velocity (3,) after dt s, by the midpoint rule in steps that the drag needs.

    Args:
        model: as of `build_model`.
        inverse_mass: (3, 3) of its first three axes.
        quat: (4,) unit, body in the world.
        rate: (3,) rad/s, body axes.
        velocity: (3,) before, m/s, through the water, body axes.
        force: (3,) of the thrusters, N, body axes.
        q: (n,) rad.
    """
    steps = int(np.ceil(dt / LONGEST))
    h = dt / steps
    v = velocity.copy()
    for _ in range(steps):
        middle = v + 0.5 * h * _acceleration(model, inverse_mass, quat, rate, v, force, q)
        v = v + h * _acceleration(model, inverse_mass, quat, rate, middle, force, q)
    return v


@exact_inner
def _acceleration(model, inverse_mass, quat, rate, velocity, force, q):
    nu = np.empty(6)
    nu[:3], nu[3:] = velocity, rate
    none = np.zeros_like(q)
    needed = inverse_dynamics(model, quat, nu, np.zeros(6), q, none, none)
    out = np.empty(3)
    for i in range(3):
        total = 0.0
        for k in range(3):
            total += inverse_mass[i, k] * (force[k] - needed[k])
        out[i] = total
    return out
