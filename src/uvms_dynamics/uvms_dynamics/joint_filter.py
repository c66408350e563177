"""The joint filter: angle, rate and acceleration of the joints, with covariance, from encoders.

One Kalman filter a joint, with one noise, that of the encoders in the vehicle file, for everyone
who needs to know how the joints move. Its state is angle, rate and a load that drifts:

    q_ddot = a + S^-1 (load - answered) - friction's slope times (q_dot - steered) + w.

Where the drives' torques are known (`command`), a is the acceleration that the commanded torque
(after its limit) should give, `answered` the load that it made up for and `steered` the rate at
which friction was compensated. What the encoders say beyond that is noise, or a load that nobody
knew: a payload, a wrong model. The load is the joint-space counterpart of the momentum residual (De
Luca and Mattone 2003); as it starts from the torque after the limit, it does not wind up. w is what
shakes the arm from below: the hull, whose thrusters follow the noise of its sensors. It counts in
the covariance, not in the gains: these are laid out for the loop, which answers a load the sooner
the less of an innovation is taken for w.

Where they are not (`without_drives`), a is zero and S one: the load is the acceleration, which
drifts, and the filter is the tracking filter of `tracking`.

A drift that suits the quiet case is too slow for a grasp. Where an innovation is beyond
`SURPRISE` standard deviations, the load's variance grows by the square of what explains it, up to
the effort of the joint: one or two samples later the load is there, and the filter is quiet again.

Samples enter by their stamps: the filter lives at the newest sample's, and the commands since then
carry its estimate to the tick.
"""

from collections import deque
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array, JointStates, to_seconds
from uvms_dynamics.kernels import joint_filter as kernels
from uvms_dynamics.kernels import layout
from uvms_dynamics.tracking import VARIANCE_FLOOR, walk


class JointDrive(NamedTuple):
    """What was commanded at a tick, (n,) each, and what it should bring about."""

    acceleration: Array  # rad/s^2, where the load is as answered and the rate as steered
    answered: Array  # load that the torque makes up for, N m
    steered: Array  # rate at which friction is compensated, rad/s
    inertia: Array  # S (n, n), kg m^2
    inverse_inertia: Array  # S^-1 (n, n)


@dataclass(frozen=True)
class JointProcess:
    """How joints move that nobody could foresee, (n,) each."""

    drift: Array  # how far the load over the inertia goes within a second, rad/s^2
    shake: Array  # density of white acceleration w, rad/s^2 s^(1/2); it does not change the gains
    surprise: Array  # greatest sudden load over the inertia, rad/s^2; 0: none is looked for


class JointEstimate(NamedTuple):
    """The joints at a time."""

    q: Array  # (n,) rad
    q_dot: Array  # (n,) rad/s
    q_ddot: Array  # (n,) rad/s^2, under what was commanded until then
    covariance: Array  # (n, 3, 3) of the three, joint by joint


class JointFilter:
    """Angles, rates, accelerations and unknown loads of the joints.

    Args:
        model: kernel tables: friction and end stops.
        load_limit: (n,) N m, bound on the load.
        variances: (2,) of the encoders' angle and rate.
        process: set later where it is not known yet, before the first step.
    """

    def __init__(
        self,
        model: Array,
        load_limit: Array,
        variances: Array,
        process: JointProcess | None = None,
    ) -> None:
        self._model, self._load_limit = model, load_limit
        self._variances = np.maximum(variances, VARIANCE_FLOOR)
        self.process: JointProcess
        if process is not None:
            self.process = process
        self.reset()

    @classmethod
    def without_drives(cls, drift: Array, variances: Array) -> "JointFilter":
        """A filter to whom nobody tells the torques: the load is the acceleration, rad/s^2.

        drift (n,): how much an acceleration changes within a second, rad/s^3.
        """
        n, none = drift.size, np.zeros(drift.size)
        free = np.zeros((n + 1, layout.MODEL_COLUMNS))
        free[:, layout.LOWER], free[:, layout.UPPER] = -np.inf, np.inf
        made = cls(free, np.full(n, np.inf), variances, JointProcess(drift, none, none))
        made.command(-1, JointDrive(none, none, none, np.eye(n), np.eye(n)))
        return made

    def reset(self) -> None:
        """Forget everything."""
        n = self._load_limit.size
        self._stamp: int | None = None
        self._x = np.zeros((3, n))  # at the stamp of the newest sample
        self._P = np.zeros((n, 3, 3))  # what the gains are made of
        self._S = np.zeros((n, 3, 4))  # of the error, and of error and shake
        self._dt, self._walk = 0.0, np.zeros((2, 3, 3))  # of drift and shake within that
        self._drives: deque[tuple[int, JointDrive]] = deque()
        self.now = self._x
        """Angles, rates and loads (3, n) at the tick of the last `step`."""

    @property
    def load(self) -> Array:
        """Torque (n,) ON the joints that the model does not know, N m."""
        load: Array = self._x[2]
        return load

    @property
    def estimate(self) -> JointEstimate:
        """The joints at the newest sample."""
        if not self._drives:  # nothing but the first sample is known
            return JointEstimate(
                self._x[0], self._x[1], np.zeros_like(self._x[0]), self._S[:, :, :3].copy()
            )
        drive = self._drives[0][1]
        since = self._dt or np.inf
        shake = self.process.shake**2 / since
        q_ddot, covariance = kernels.acceleration(
            self._model, self._x, self._S, tuple(drive), shake
        )
        return JointEstimate(self._x[0].copy(), self._x[1].copy(), q_ddot, covariance)

    def set_drift(self, drift: Array) -> None:
        """Change the drift (n,), rad/s^3; where there was but one sample, that of its load too."""
        self.process = replace(self.process, drift=drift)
        if not self._dt:
            self._P[:, 2, 2] = self._S[:, 2, 2] = drift**2

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
        for i, drift in enumerate(self.process.drift):
            self._P[i] = self._S[i, :, :3] = np.diag((*self._variances, drift**2))

    def _to(self, stamp: int, measured: Array) -> None:
        """Move the filter to a new sample and take it in."""
        dt, drive = 0.0, self._drives[0][1]
        for dt, drive in self._pieces(self._stamp or 0, stamp):
            if dt != self._dt:
                self._dt, self._walk = dt, _walks(dt)
            kernels.advance(
                self._model, self._x, self._P, self._S, dt, tuple(drive),
                self.process.drift, self.process.shake, self._walk,
            )  # fmt: skip
        kernels.take_in(
            self._model,
            self._x,
            self._P,
            self._S,
            dt,
            measured,
            self._variances,
            self.process.surprise,
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
            kernels.carry(self._model, x, dt, tuple(drive))
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


def _walks(dt: float) -> Array:
    """Covariances (2, 3, 3) of a unit drift of the load and of a unit white acceleration in dt."""
    shaken = np.zeros((3, 3))
    shaken[:2, :2] = walk(2, dt)
    return np.array((walk(3, dt), shaken))
