"""The joints at a control tick, from encoders that may be late.

A joint state of stamp s that is used at the tick t is old by d = t - s. What is fed forward of it
is then wrong by what the joints did within d, which acts as a delay in the loop. So it is carried
to the tick with the joints' acceleration, which the joint filter finds at the stamps:

    q(t) = q(s) + q_dot(s) d + 1/2 q_ddot d^2,   q_dot(t) = q_dot(s) + q_ddot d.

At d = 0 that is the measurement itself. What is left is the change of the acceleration, of the
order of jerk d^2 / 2 in the rate. The error of q_ddot counts d times in the rate, so that a
prediction is worth less the older the state is; `joint_age_limit` says where it ends.

What is fed forward of q_ddot accelerates the hull, and that the joints again. On time the loop is
closed before it can swing; late by d it would do so at about 1/d, if the filter followed that fast.
So its bandwidth is at most `RADIANS_OF_AGE` / d.
"""

import numpy as np

from uvms_core import checks
from uvms_core.signals import Array, JointStates, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics.joint_filter import JointEstimate, JointFilter
from uvms_dynamics.tracking import VARIANCE_FLOOR, transition, walk

RADIANS_OF_PERIOD = np.pi / 2.0
"""Bandwidth of the acceleration times the time between two samples, by rule: half of the highest
frequency that samples can show."""

RADIANS_OF_AGE = 1.0 / 3.0
"""Bandwidth of the acceleration times the age of the samples: it is carried to the tick unchanged,
and what changes faster would come with the wrong phase. As of every loop here, a third of the
inverse of the delay."""


class JointPrediction:
    """Joints at the tick, from encoder samples by their stamps.

    Args:
        vehicle: noise of the encoders, lag of the thrusters.
        jerk_rad_s3: how much a joint's acceleration changes within one second; None: by rule, that
            of the bandwidth `RADIANS_OF_PERIOD` over the time between two samples.
        age_limit_s: greatest age of a joint state; None: `joint_age_limit` at the interval between
            the last two ticks.
    """

    def __init__(
        self,
        vehicle: Vehicle,
        jerk_rad_s3: float | None = None,
        age_limit_s: float | None = None,
    ) -> None:
        self._vehicle = vehicle
        self._jerk = jerk_rad_s3
        self._suited = (0.0, 0.0)  # age of the last sample when it came and its interval, s
        self._variances = encoder_variances(vehicle)
        drift = np.full(vehicle.n_joints, jerk_rad_s3 or 0.0)
        self.filter = JointFilter.without_drives(drift, self._variances)
        self._limit = age_limit_s
        self._stamp: int | None = None  # of the last sample
        self._tick: int | None = None

    def check(self, joints: JointStates, tick: int) -> None:
        """SignalError where the joint state is newer than the tick, ns, or too old for it."""
        if joints.stamp != tick:
            checks.age("joint_states", joints.stamp, tick, self.age_limit_s(tick))

    def age_limit_s(self, tick: int) -> float:
        """Greatest age, s, at this tick, ns."""
        if self._limit is not None:
            return self._limit
        if self._tick is None or tick <= self._tick:
            return checks.MAX_AGE_S
        return joint_age_limit(self._vehicle, to_seconds(tick - self._tick))

    def step(self, joints: JointStates, tick: int) -> JointEstimate:
        """The joints at a tick, ns; `check` comes before.

        A sample that has been seen is not taken in again, only carried further.
        """
        age = to_seconds(tick - joints.stamp)
        if self._stamp is None or joints.stamp > self._stamp:
            self._suit(age, 0.0 if self._stamp is None else to_seconds(joints.stamp - self._stamp))
            self.filter.step(joints, joints.stamp)
            self._stamp = joints.stamp
        self._tick = tick
        found = self.filter.estimate
        # Filtered rates lag, and the momentum residual takes their differences for forces.
        q_dot = joints.velocity + age * found.q_ddot
        q = joints.position + 0.5 * age * (joints.velocity + q_dot)
        return JointEstimate(q, q_dot, found.q_ddot, self._carried(found.covariance, age))

    def _carried(self, covariance: Array, age: float) -> Array:
        """Of a measurement, and a filtered acceleration, that are carried on by age, s."""
        start = covariance.copy()
        start[:, :2, :] = start[:, :, :2] = 0.0
        start[:, [0, 1], [0, 1]] = self._variances
        F, drift = transition(3, age), self.filter.process.drift**2
        return np.asarray(F @ start @ F.T + drift[:, None, None] * walk(3, age))

    def _suit(self, age: float, dt: float) -> None:
        """Let the filter be as fast as samples of this age, s, allow; dt s is their interval."""
        if (age, dt) == self._suited or dt <= 0.0:
            return
        self._suited = age, dt
        jerk = self._jerk or jerk_for(RADIANS_OF_PERIOD / dt, self._variances, dt)
        if age > 0.0:
            jerk = min(jerk, jerk_for(RADIANS_OF_AGE / age, self._variances, dt))
        self.filter.set_drift(np.full(self._vehicle.n_joints, jerk))


def carried_by_rate(joints: JointStates, tick: int) -> Array:
    """Angles (n,) rad at a tick, ns, of a joint state that may be late, by its own rates.

    For who looks at the joints too seldom for a filter. Nothing is carried on for longer than
    `MAX_AGE_S`, after which nobody would still use it.
    """
    age = min(max(to_seconds(tick - joints.stamp), 0.0), checks.MAX_AGE_S)
    return joints.position + age * joints.velocity


def jerk_for(bandwidth: float, variances: Array, interval_s: float) -> float:
    """Jerk J, rad/s^3 within one second, that gives the filter of the joints this bandwidth, rad/s.

    With sigma sqrt(T) the density of the noise, the acceleration has the bandwidth
    (J / (sigma sqrt(T)))^(1/3) where the filter reads the angle, and the same to the power of 1/2
    where it reads the rate (continuous-time solution of the Riccati equation); the faster counts.

    Args:
        bandwidth: of the acceleration.
        variances: (2,) of angle and rate.
        interval_s: T, between two samples.
    """
    angle, rate = np.sqrt(np.maximum(variances, VARIANCE_FLOOR) * interval_s)
    return float(min(bandwidth**3 * angle, bandwidth**2 * rate))


def jerk_of_velocity(noise: Array, interval_s: float) -> Array:
    """Jerks by rule (k,) of filters that read a velocity with this white noise (k,), std.

    That of the bandwidth B = `RADIANS_OF_PERIOD` / T at the interval T: B^2 sigma sqrt(T).
    """
    return (RADIANS_OF_PERIOD / interval_s) ** 2 * noise * np.sqrt(interval_s)


def loop_delay(vehicle: Vehicle, period_s: float) -> float:
    """Delay, s, between a state and the wrench that answers it: thruster lag, hold and computation.

    The slowest thruster's time constant, half a period for the constant command (Franklin, Powell
    and Workman, Digital Control, sec. 4.5) and one period from the measurement to the command.
    """
    lag = max((thruster.time_constant_s for thruster in vehicle.thrusters), default=0.0)
    return lag + 1.5 * period_s


def joint_age_limit(vehicle: Vehicle, period_s: float) -> float:
    """Greatest age, s, of joint states in a loop of this period.

    As much delay again as the loop has: bandwidths are at most a third of its inverse, so that the
    phase falls by another third of a radian, which the margins stand.
    """
    return loop_delay(vehicle, period_s)


def encoder_variances(vehicle: Vehicle) -> Array:
    """Variances (2,) of angle and rate, rad^2 and (rad/s)^2; rounding to a step s adds s^2 / 12."""
    encoders = vehicle.sensors.encoders
    angle = encoders.noise_deg**2 + encoders.resolution_deg**2 / 12.0
    return np.radians(1.0) ** 2 * np.array([angle, encoders.rate_noise_deg_s**2])
