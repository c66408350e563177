"""Joints at a control tick and the load that the model does not know, from encoders and torques.

What the drives were told, and the model, say how a joint should have moved; what the encoders say
beyond that is noise, or a load that nobody knew: a payload, a wrong model. A Kalman filter a joint
tells the two apart. Its state is angle, rate and a load that drifts:

    q_ddot = a + S^-1 (load - answered) - friction's slope times (q_dot - steered),

where a is the acceleration that the commanded torque (after its limit) should give, `answered` the
load that it made up for and `steered` the rate at which friction was compensated. The load is the
joint-space counterpart of the momentum residual (De Luca and Mattone 2003); as it starts from the
torque after the limit, it does not wind up.

A drift that suits the quiet case is too slow for a grasp. Where an innovation is beyond
`SURPRISE` standard deviations, the load's variance grows by the square of what explains it, up to
the effort of the joint: one or two samples later the load is there, and the filter is quiet again.

Samples enter by their stamps: the filter lives at the newest sample's, and the commands since then
carry its estimate to the tick.
"""

from collections import deque
from typing import NamedTuple

import numpy as np

from uvms_control.arm_gains import ArmGains
from uvms_core.signals import Array, JointStates, to_seconds
from uvms_dynamics.kernels import layout
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.tracking import VARIANCE_FLOOR, walk

SURPRISE = 4.0
"""Innovation, in standard deviations, beyond which noise does not explain it: 1 in 16,000."""


class JointDrive(NamedTuple):
    """What was commanded at a tick, (n,) each, and what it should bring about."""

    acceleration: Array  # rad/s^2, where the load is as answered and the rate as steered
    answered: Array  # load that the torque makes up for, N m
    steered: Array  # rate at which friction is compensated, rad/s
    inertia: Array  # S (n, n), kg m^2
    inverse_inertia: Array  # S^-1 (n, n)


class JointObserver:
    """Angles, rates and unknown loads of the joints.

    Args:
        model: kernel tables: friction and end stops.
        effort_limit: (n,) N m.
        load_limit: (n,) N m, bound on the load.
        variances: (2,) of the encoders' angle and rate.
    """

    def __init__(
        self, model: Array, effort_limit: Array, load_limit: Array, variances: Array
    ) -> None:
        self._model, self._effort_limit, self._load_limit = model, effort_limit, load_limit
        self._variances = np.maximum(variances, VARIANCE_FLOOR)
        self.gains: ArmGains
        """Drift of the load, and inertia; set before the first step."""
        self.reset()

    def reset(self) -> None:
        """Forget everything."""
        n = self._effort_limit.size
        self._stamp: int | None = None
        self._x = np.zeros((3, n))  # at the stamp of the newest sample
        self._P = np.zeros((n, 3, 3))
        self._dt, self._walk = 0.0, np.zeros((3, 3))  # drift within that
        self._drives: deque[tuple[int, JointDrive]] = deque()
        self.now = self._x
        """Angles, rates and loads (3, n) at the tick of the last `step`."""

    @property
    def load(self) -> Array:
        """Torque (n,) ON the joints that the model does not know, N m."""
        load: Array = self._x[2]
        return load

    def step(self, joints: JointStates, tick: int) -> Array:
        """Angles, rates and loads (3, n) at a tick, ns, with the sample that is here by then."""
        if self._stamp is None:
            self._start(joints)
        elif joints.stamp > self._stamp:
            measured = np.array((joints.position, joints.velocity))
            self._to(joints.stamp, measured)
        self.now = self._carried(tick)
        return self.now

    def command(self, tick: int, drive: JointDrive) -> None:
        """Take note of what is commanded from a tick, ns, on."""
        self._drives.append((tick, drive))

    def shift_load(self, change: Array) -> None:
        """The model has changed: the load (n,) N m that it does not know changes with it."""
        self._x[2] += change
        if self.now is not self._x:
            self.now[2] += change

    def _start(self, joints: JointStates) -> None:
        self._stamp = joints.stamp
        self._x[0], self._x[1], self._x[2] = joints.position, joints.velocity, 0.0
        for i, drift in enumerate(self.gains.drift):
            self._P[i] = np.diag((*self._variances, drift**2))

    def _to(self, stamp: int, measured: Array) -> None:
        """Move the filter to a new sample and take it in."""
        dt, drive = 0.0, self._drives[0][1]
        for dt, drive in self._pieces(self._stamp or 0, stamp):
            if dt != self._dt:
                self._dt, self._walk = dt, walk(3, dt)
            _advance(self._model, self._x, self._P, dt, tuple(drive), self.gains.drift, self._walk)
        _take_in(
            self._model,
            self._x,
            self._P,
            dt,
            measured,
            self._variances,
            self._effort_limit / self.gains.inertia,
            drive.inertia,
            self._load_limit,
        )
        self._stamp = stamp
        while len(self._drives) > 1 and self._drives[1][0] <= stamp:
            self._drives.popleft()

    def _carried(self, tick: int) -> Array:
        """The estimate at the tick, by the commands since the sample."""
        if tick == self._stamp:
            return self._x
        x = self._x.copy()
        for dt, drive in self._pieces(self._stamp or 0, tick):
            _carry(self._model, x, dt, tuple(drive))
        return x

    def _pieces(self, begin: int, end: int) -> list[tuple[float, JointDrive]]:
        """The intervals of one command each between two stamps."""
        starts = [stamp for stamp, _ in self._drives]
        found = []
        for number, (start, drive) in enumerate(self._drives):
            until = starts[number + 1] if number + 1 < len(starts) else end
            first, last = max(start, begin) if number else begin, min(until, end)
            if last > first:
                found.append((to_seconds(last - first), drive))
        return found


@exact_inner
def _response(model: Array, i: int, x: Array, drive: tuple, dt: float) -> tuple:
    """Acceleration of joint i at the rate it was steered to, and what friction makes of dt.

    phi: what is left of a rate's difference; e1, e2: its integral and its double integral.
    """
    acceleration, answered, steered, _, inverse = drive
    a = acceleration[i]
    for j in range(acceleration.shape[0]):
        a += inverse[i, j] * (x[2, j] - answered[j])
    rate, aim = x[1, i], steered[i]
    slope, width = model[i + 1, layout.VISCOUS], model[i + 1, layout.INVERSE_WIDTH]
    coulomb = model[i + 1, layout.COULOMB]
    apart = (rate - aim) * width
    if abs(apart) > 1e-6:
        slope += coulomb * width * (np.tanh(rate * width) - np.tanh(aim * width)) / apart
    else:
        slope += coulomb * width * (1.0 - np.tanh(aim * width) ** 2)
    decay = slope * inverse[i, i]
    if decay * dt < 1e-6:
        return a, decay, 1.0, dt, 0.5 * dt * dt
    phi = np.exp(-decay * dt)
    e1 = (1.0 - phi) / decay
    return a, decay, phi, e1, (dt - e1) / decay


@exact_kernel
def _carry(model: Array, x: Array, dt: float, drive: tuple) -> None:
    """Angles and rates (in place) after dt."""
    steered = drive[2]
    before = x.copy()
    for i in range(x.shape[1]):
        a, decay, _, e1, e2 = _response(model, i, before, drive, dt)
        a -= decay * (before[1, i] - steered[i])
        x[0, i] += before[1, i] * dt + a * e2
        x[1, i] += a * e1


@exact_kernel
def _advance(
    model: Array, x: Array, P: Array, dt: float, drive: tuple, drift: Array, walk: Array
) -> None:
    """As `_carry`, with the covariance P (n, 3, 3)."""
    F = np.eye(3)
    for i in range(x.shape[1]):
        _, _, phi, e1, e2 = _response(model, i, x, drive, dt)
        F[0, 1], F[0, 2], F[1, 1], F[1, 2] = e1, e2, phi, e1
        P[i] = F @ P[i] @ F.T + drift[i] ** 2 * walk
    _carry(model, x, dt, drive)


@exact_kernel
def _take_in(
    model: Array,
    x: Array,
    P: Array,
    dt: float,
    measured: Array,
    variances: Array,
    surprise: Array,
    inertia: Array,
    load_limit: Array,
) -> None:
    """Correct estimate and covariance (in place) by angles and rates (2, n)."""
    n = x.shape[1]
    jump = np.zeros(n)
    for i in range(n):
        _widen(P[i], dt, measured[0, i] - x[0, i], measured[1, i] - x[1, i], variances, surprise[i])
        # In a stop its push is no load, or the drive would press against it.
        angle = measured[0, i]
        touches = angle > model[i + 1, layout.UPPER] or angle < model[i + 1, layout.LOWER]
        for m in range(2):
            total = P[i, m, m] + variances[m]
            k0, k1, k2 = P[i, 0, m] / total, P[i, 1, m] / total, P[i, 2, m] / total
            if touches:
                k2 = 0.0
            innovation = measured[m, i] - x[m, i]
            x[0, i] += k0 * innovation
            x[1, i] += k1 * innovation
            jump[i] += k2 * innovation
            _correct(P[i], m, k0, k1, k2, variances[m])
    for i in range(n):
        load = x[2, i]
        for j in range(n):
            load += inertia[i, j] * jump[j]
        x[2, i] = min(max(load, -load_limit[i]), load_limit[i])


@exact_inner
def _widen(P: Array, dt: float, angle: float, rate: float, variances: Array, most: float) -> None:
    """Add the variance of a sudden load to P where the innovations are beyond noise."""
    limit = SURPRISE**2
    if angle**2 < limit * (P[0, 0] + variances[0]) and rate**2 < limit * (P[1, 1] + variances[1]):
        return
    size = min(max(abs(rate) / dt, 2.0 * abs(angle) / dt**2), most)
    b = (0.5 * dt * dt, dt, 1.0)
    for i in range(3):
        for j in range(3):
            P[i, j] += size * size * b[i] * b[j]


@exact_inner
def _correct(P: Array, m: int, k0: float, k1: float, k2: float, variance: float) -> None:
    """P after a measurement of state m with these gains, in the Joseph form."""
    left = np.eye(3)
    left[0, m] -= k0
    left[1, m] -= k1
    left[2, m] -= k2
    k = np.array((k0, k1, k2))
    P[:] = left @ P @ left.T + variance * np.outer(k, k)
