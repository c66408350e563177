"""Joint corrections that keep the end effector on its path when the vehicle is off its own.

The correction that the estimated pose needs contains the estimate's noise, and what passes through
the inverse Jacobian shakes the arm: each step of the estimate asks for an acceleration, and the
arm's reaction pushes the vehicle. A correction that follows with the bandwidth w (critically
damped) a demand that steps by s each period T,

    c'' = w^2 (demand - c) - 2 w (c' - g demand'),      E[c''^2] = w^3 s^2 / (4 T),

has errors that fall with 1 / sqrt(w), while accelerations grow with w^(3/2). So the noise decides:
it may cost `noise_share` of the moment that the thrusters have,

    sum over joints of  p^2 w^3 s^2 / (4 T)  =  (noise_share * moment)^2,

where p is the moment on the hull that the joint's acceleration makes, a column of the mass matrix.
Of all bandwidths that cost this, those with w ~ sqrt(l / p) leave the least error of the tool, l
being the joint's lever, the length of its column of J. s is found from third differences of the
demand, which steady motion, swell as well, does not show, but every step does. A better estimate
makes the arm follow faster, without noise as fast as its joints can.

Where the arm's reaction moves the free hull as much as the joint moves the tool (a dynamic
singularity: Papadopoulos and Dubowsky 1993), only the hull's own loop makes the motion count, and
the joint must not be faster than that: w is at most (1 - r) of what the joints' loops can follow
and r of what the hull's loop can, r being the share that the free hull takes back.

What the vehicle does steadily (swell) is followed without lag, by the rate of the demand, as far as
the estimated velocity is worth it: g = 1 - (its variance by its own covariance) / (its mean square)
is the gain of a Wiener filter for a signal in noise of known power.

Where the vehicle's own loop is faster than the filter, a correction c comes too late and would add
to the error: of it is kept <d c> / <c^2>, d being the demand, which leaves the least of d - a c.

A correction is worth what it brings. Where the vehicle has been carried away farther than the arm
reaches, its bounds leave the tool off all the same, and an arm that is stretched for nothing tips
the hull. With g the motion of the tool that the bounded correction gives, and l what the bounds
take from it, w = |g| / (|g| + |l|) is what it is worth, and w^2 (3 - 2 w) of it is asked for: all
of it within the bounds, nothing far beyond them, and smoothly between the two.

An error along an axis that neither thrusters nor hull bring back only grows (`as_if_held`): the arm
would be stretched after it as far as it goes, and is not. Of an axis that only the hull brings back
the arm makes up for its rest and not for its swing (`HullSwing`).
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from uvms_control.arm_config import CompensationConfig
from uvms_control.controlled_axes import Flags
from uvms_control.reference import ReferenceSample
from uvms_control.tracking_error import TrackingError
from uvms_core.signals import Array, Odometry
from uvms_dynamics import Model, end_effector, end_effector_jacobian
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import (
    quat_multiply,
    quat_to_matrix,
    rotation_vector_to_quat,
)

# Gauss-Newton steps: the first leaves 1 % or so to damping and curvature, the second nothing.
ITERATIONS = 2
MEMORY_S = 20.0
"""Over which noise and motion are averaged: several periods of swell."""
# Of a random walk with steps s the third differences are s_k - 2 s_(k-1) + s_(k-2).
THIRD_DIFFERENCE = 6.0
OUTLIER = 4.0
SMALLEST_PUSH = 1e-9  # N m s^2; keeps ratios finite
NOT_RIGHTED = np.array([True, True, True, False, False, True])
"""Axes along which nothing but thrusters brings a vehicle back; roll and pitch have the hull."""


class JointCorrection(NamedTuple):
    """Correction added to the joint reference, (n,) each."""

    angle: Array  # rad
    rate: Array  # rad/s
    acceleration: Array  # rad/s^2


def as_if_held(
    odometry: Odometry,
    tracking: TrackingError,
    is_controlled: Flags,
    swing: tuple[Array, Array] | None = None,
) -> Odometry:
    """The vehicle as it would be without its error along axes that nothing brings it back along.

    Args:
        odometry: estimated state.
        tracking: errors against the reference, body frame.
        is_controlled: (6,) axes that the thrusters control.
        swing: what else is left out, of error and rate (6,) each, as of `HullSwing.step`.
    """
    gone = NOT_RIGHTED & ~is_controlled
    error, rate = np.where(gone, tracking.error, 0.0), np.where(gone, tracking.rate, 0.0)
    if swing is not None:
        error, rate = error + swing[0], rate + swing[1]
    if not (error.any() or rate.any()):
        return odometry
    return replace(
        odometry,
        position=odometry.position + quat_to_matrix(odometry.quaternion) @ error[:3],
        quaternion=quat_multiply(odometry.quaternion, rotation_vector_to_quat(error[3:])),
        nu=odometry.nu + rate,
    )


class EndEffectorCompensation:
    """Resolved motion with damped least squares on the arm's block of the Jacobian, eq. (12).

    Args:
        model: kernel tables.
        config: bounds, and the share of the moment that noise may cost.
        lower, upper: (n,) joint limits, rad.
        moment: smallest moment that the thrusters have about an axis, N m.
    """

    fastest: float
    """Greatest bandwidth, rad/s: what the joints' loops can follow."""
    hull: float
    """The same where the arm's reaction moves the hull as much as the tool: what its loop holds."""

    def __init__(
        self, model: Model, config: CompensationConfig, lower: Array, upper: Array, moment: float
    ) -> None:
        self._model, self._config = model, config
        middle = 0.5 * (lower + upper)
        self._lower = np.minimum(lower + config.joint_margin, middle)
        self._upper = np.maximum(upper - config.joint_margin, middle)
        self._price = (config.noise_share * moment) ** 2
        self.fastest = self.hull = np.inf
        self.reset()

    def reset(self) -> None:
        """Reset the correction to zero."""
        n = self._lower.size
        self._state = np.zeros((2, n))  # angle and rate of the correction
        self._demands = np.zeros((3, n))  # the last three, the newest first
        self._seen = 0
        self._steps = np.zeros(n)  # mean square of the demand's third differences
        self._powers = np.zeros(2)  # mean squares of the demand's rate, and of its noise
        self._use = np.zeros((2, n))  # means of demand times correction, and of its square
        self.bandwidth = np.zeros(n)
        self.rate_gain = np.zeros(n)

    def step(
        self, odometry: Odometry, desired: ReferenceSample, mass: Array, dt: float
    ) -> JointCorrection:
        """Follow the correction that this vehicle pose needs, bounded in angle and rate.

        The demand is computed from zero each time, so that it vanishes with the vehicle's error
        and nothing drifts where the arm is redundant.
        """
        if dt <= 0.0:
            return JointCorrection(self._state[0], self._state[1], np.zeros(self._lower.size))
        low, high = self._bounds(desired.q)
        own, config = self._config.bandwidth, self._config
        followed = _compensate(
            self._model,
            (odometry.position, odometry.quaternion, odometry.nu, odometry.twist_covariance),
            (desired.quaternion, desired.nu, desired.q, desired.end_effector),
            mass,
            (low, high),
            (config.damping, config.max_rate, self._price, self.fastest, self.hull, own or 0.0),
            (self._state, self._demands, self._steps, self._powers, self._use),
            (self.bandwidth, self.rate_gain),
            self._seen,
            dt,
        )
        self._seen += 1
        return JointCorrection(followed[0], followed[1], followed[2])

    def _bounds(self, q: Array) -> tuple[Array, Array]:
        """The largest angle and the joint limits, but never away from a reference there."""
        low = np.maximum(np.minimum(self._lower - q, 0.0), -self._config.max_angle)
        high = np.minimum(np.maximum(self._upper - q, 0.0), self._config.max_angle)
        return low, high


@exact_kernel
def _compensate(
    model: Array,
    at: tuple,
    to: tuple,
    mass: Array,
    bounds: tuple,
    numbers: tuple,
    memory: tuple,
    chosen: tuple,
    seen: int,
    dt: float,
) -> Array:
    """The next correction (3, n); `memory` and `chosen`, bandwidth and rate gain, are renewed."""
    damping, max_rate, price, fastest, hull, own = numbers
    state, demands, steps, powers, use = memory
    bandwidth, rate_gain = chosen
    low, high = bounds
    wanted, rate, noise, recoil, worth, push = _demand(model, at, to, mass, low, high, damping)
    _note(wanted, rate, noise, price, fastest, push, seen, dt, demands, steps, powers)
    scale = _scale(steps, worth, push, price, dt)
    share = max(0.0, 1.0 - powers[1] / powers[0]) if powers[0] > 0.0 else 0.0
    for i in range(wanted.shape[0]):
        free = 1.0 - min(max(recoil[i], 0.0), 1.0)
        rate_gain[i] = free * share
        most = free * fastest + (1.0 - free) * hull
        bandwidth[i] = own if own > 0.0 else min(scale * np.sqrt(worth[i] / push[i]), most)
    out = _follow(state, wanted, rate_gain * rate, bandwidth, dt, low, high, max_rate)
    state[:] = out[:2]
    _keep_what_helps(use, wanted, out, max(dt / MEMORY_S, 1.0 / (seen + 1)))
    return out


@exact_inner
def _keep_what_helps(use: Array, wanted: Array, out: Array, share: float) -> None:
    """Scale the correction (in place) by <d c> / <c^2>, at most 1: least squares of d - a c."""
    for i in range(wanted.shape[0]):
        use[0, i] += share * (wanted[i] * out[0, i] - use[0, i])
        use[1, i] += share * (out[0, i] ** 2 - use[1, i])
        if use[1, i] > 0.0:
            gain = min(max(use[0, i] / use[1, i], 0.0), 1.0)
            for k in range(3):
                out[k, i] *= gain


@exact_inner
def _demand(
    model: Array, at: tuple, to: tuple, mass: Array, low: Array, high: Array, damping: float
) -> tuple:
    """Smallest correction (n,) of q, within its bounds, that brings the tool to the target.

    Also the rate (n,) at which the vehicle's motion changes it; the variance of that rate's noise,
    the sum of all joints, (rad/s)^2; and of every joint its recoil: how much of the tool's motion
    by it the free hull takes back, the length of its column of J, m, and the moment on the hull
    that its acceleration makes, N m s^2.
    """
    position, quaternion, nu, covariance = at
    desired_quaternion, desired_nu, q, target = to
    n = q.shape[0]
    correction = np.zeros(n)
    for _ in range(ITERATIONS):
        tool, _ = end_effector(model, position, quaternion, q + correction)
        jacobian = end_effector_jacobian(model, quaternion, q + correction)[:3].copy()
        inverse = _damped_inverse(jacobian[:, 6:].copy(), damping)
        asked = correction + inverse @ (target - tool)
        correction = np.minimum(np.maximum(asked, low), high)
    kept = _share_worth(jacobian[:, 6:].copy(), asked, correction)
    of_vehicle = jacobian[:, :6].copy()
    planned = end_effector_jacobian(model, desired_quaternion, q)[:3, :6].copy()
    rate = inverse @ (planned @ desired_nu - of_vehicle @ nu)
    spread = inverse @ of_vehicle
    noise = 0.0
    recoil, worth, push = np.empty(n), np.empty(n), np.empty(n)
    pushed = np.linalg.solve(mass[:6, :6].copy(), mass[:6, 6:].copy())
    for i in range(n):
        noise += spread[i] @ (covariance @ spread[i])
        recoil[i] = spread[i] @ pushed[:, i].copy()
        worth[i] = np.sqrt((jacobian[:, 6 + i] ** 2).sum())
        push[i] = np.sqrt((mass[3:6, 6 + i] ** 2).sum()) + SMALLEST_PUSH
    return kept * correction, kept * rate, noise, recoil, worth, push


@exact_inner
def _share_worth(jacobian: Array, asked: Array, bounded: Array) -> float:
    """Share, 0 to 1, of the bounded correction (n,) that is asked for; 1 where no bound matters."""
    lost = np.sqrt(((jacobian @ (asked - bounded)) ** 2).sum())
    if lost == 0.0:
        return 1.0
    gained = np.sqrt(((jacobian @ bounded) ** 2).sum())
    share = gained / (gained + lost)
    return share * share * (3.0 - 2.0 * share)


@exact_inner
def _note(
    wanted: Array,
    rate: Array,
    noise: float,
    price: float,
    fastest: float,
    push: Array,
    seen: int,
    dt: float,
    demands: Array,
    steps: Array,
    powers: Array,
) -> None:
    """Average the steps and the rate of the demand.

    A single jump, as of a fix of the position, is no noise: no step counts more than `OUTLIER`
    standard deviations, of those that are or of those that would cost something.
    """
    if seen >= 3:
        share = max(dt / MEMORY_S, 1.0 / (seen - 2))
        for i in range(wanted.shape[0]):
            step = wanted[i] - 3.0 * demands[0, i] + 3.0 * demands[1, i] - demands[2, i]
            dear = THIRD_DIFFERENCE * 4.0 * dt * price / (push[i] ** 2 * fastest**3)
            most = OUTLIER**2 * max(steps[i], dear)
            steps[i] += share * (min(step * step, most) - steps[i])
        powers[0] += share * (rate @ rate - powers[0])
        powers[1] += share * (noise - powers[1])
    demands[2], demands[1], demands[0] = demands[1].copy(), demands[0].copy(), wanted


@exact_inner
def _scale(steps: Array, worth: Array, push: Array, price: float, dt: float) -> float:
    """Lambda of the bandwidths lambda sqrt(worth / push) at which noise costs the price.

    A joint's noise costs push^2 w^3 and leaves an error of worth^2 / w in the tool: the least error
    for the price has w^4 ~ worth^2 / push^2.
    """
    cost = 0.0
    for i in range(steps.shape[0]):
        cost += push[i] ** 2 * steps[i] * (worth[i] / push[i]) ** 1.5
    cost /= THIRD_DIFFERENCE * 4.0 * dt
    return (price / max(cost, 1e-30)) ** (1.0 / 3.0)


@exact_inner
def _damped_inverse(jacobian: Array, damping: float) -> Array:
    """J^T (J J^T + damping^2 I)^-1."""
    damped = jacobian @ jacobian.T + damping**2 * np.eye(3)
    inverse = np.empty((jacobian.shape[1], 3))
    inverse[:] = np.linalg.solve(damped, jacobian).T
    return inverse


@exact_inner
def _follow(
    state: Array,
    wanted: Array,
    rate: Array,
    bandwidth: Array,
    dt: float,
    low: Array,
    high: Array,
    max_rate: float,
) -> Array:
    """Angle, rate and acceleration (3, n) after dt: critically damped, exact for a demand that
    moves at a constant rate; the acceleration is the mean over dt.
    """
    n = wanted.shape[0]
    out = np.empty((3, n))
    for i in range(n):
        w = bandwidth[i]
        decay = np.exp(-w * dt)
        # The demand is that of now; it was at wanted - rate dt when the state was made.
        apart = state[0, i] - (wanted[i] - rate[i] * dt)
        slip = state[1, i] - rate[i]
        mixed = slip + w * apart
        speed = (slip - w * mixed * dt) * decay + rate[i]
        speed = min(max(speed, -max_rate), max_rate)
        angle = wanted[i] + (apart + mixed * dt) * decay
        angle = state[0, i] + min(max(angle - state[0, i], -max_rate * dt), max_rate * dt)
        inside = min(max(angle, low[i]), high[i])
        out[0, i], out[1, i] = inside, speed if inside == angle else 0.0
        out[2, i] = (out[1, i] - state[1, i]) / dt
    return out
