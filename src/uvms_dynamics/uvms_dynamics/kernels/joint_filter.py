"""Kernels of the joint filter (`uvms_dynamics.joint_filter`): one joint after the other.

x (3, n): angles rad, rates rad/s, loads N m; P (n, 3, 3): the covariance that the gains are made
of, the load's over the inertia, rad/s^2; S (n, 3, 4): that of the error that these gains leave, and
beside it its covariance with the mean of the last interval's shake; drive: a `JointDrive` as a
tuple.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels import layout
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel

SURPRISE = 4.0
"""Innovation, in standard deviations, beyond which noise does not explain it: 1 in 16,000."""


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
def carry(model: Array, x: Array, dt: float, drive: tuple) -> None:
    """Angles and rates (in place) after dt."""
    steered = drive[2]
    before = x.copy()
    for i in range(x.shape[1]):
        a, decay, _, e1, e2 = _response(model, i, before, drive, dt)
        a -= decay * (before[1, i] - steered[i])
        x[0, i] += before[1, i] * dt + a * e2
        x[1, i] += a * e1


@exact_kernel
def advance(
    model: Array,
    x: Array,
    P: Array,
    S: Array,
    dt: float,
    drive: tuple,
    drift: Array,
    shake: Array,
    walks: Array,
) -> None:
    """As `carry`, with the covariances (in place); walks (2, 3, 3): of unit drift and shake."""
    F = np.eye(3)
    for i in range(x.shape[1]):
        _, _, phi, e1, e2 = _response(model, i, x, drive, dt)
        F[0, 1], F[0, 2], F[1, 1], F[1, 2] = e1, e2, phi, e1
        Q = drift[i] ** 2 * walks[0]
        P[i] = F @ P[i] @ F.T + Q
        S[i, :, :3] = F @ S[i, :, :3].copy() @ F.T + Q + shake[i] ** 2 * walks[1]
        S[i, :, 3] = -(shake[i] ** 2) * np.array((0.5 * dt, 1.0, 0.0))
    carry(model, x, dt, drive)


@exact_kernel
def acceleration(model: Array, x: Array, S: Array, drive: tuple, shake: Array) -> tuple:
    """Accelerations (n,) under a drive, and covariances (n, 3, 3) of angle, rate and acceleration.

    shake (n,): variance of the white acceleration's mean, (rad/s^2)^2.
    """
    n = x.shape[1]
    q_ddot, covariance = np.empty(n), np.empty((n, 3, 3))
    for i in range(n):
        a, decay, _, _, _ = _response(model, i, x, drive, 0.0)
        q_ddot[i] = a - decay * (x[1, i] - drive[2][i])
        J = np.eye(3)
        J[2, 1] = -decay
        covariance[i] = J @ S[i, :, :3].copy() @ J.T
        shared = J @ S[i, :, 3].copy()
        covariance[i, :, 2] -= shared
        covariance[i, 2, :] -= shared
        covariance[i, 2, 2] += shake[i]
    return q_ddot, covariance


@exact_kernel
def take_in(
    model: Array,
    x: Array,
    P: Array,
    S: Array,
    dt: float,
    measured: Array,
    variances: Array,
    surprise: Array,
    inertia: Array,
    load_limit: Array,
) -> None:
    """Correct estimate and covariances (in place) by angles and rates (2, n)."""
    n = x.shape[1]
    jump = np.zeros(n)
    for i in range(n):
        apart = measured[0, i] - x[0, i], measured[1, i] - x[1, i]
        _widen(P[i], S[i], dt, apart, variances, surprise[i])
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
            _correct_both(S[i], m, k0, k1, k2, variances[m])
    for i in range(n):
        load = x[2, i]
        for j in range(n):
            load += inertia[i, j] * jump[j]
        x[2, i] = min(max(load, -load_limit[i]), load_limit[i])


@exact_inner
def _widen(P: Array, S: Array, dt: float, apart: tuple, variances: Array, most: float) -> None:
    """Add the variance of a sudden load where the innovations (angle, rate) are beyond noise."""
    angle, rate = apart
    limit = SURPRISE**2
    if angle**2 < limit * (P[0, 0] + variances[0]) and rate**2 < limit * (P[1, 1] + variances[1]):
        return
    size = min(max(abs(rate) / dt, 2.0 * abs(angle) / dt**2), most)
    b = (0.5 * dt * dt, dt, 1.0)
    for i in range(3):
        for j in range(3):
            P[i, j] += size * size * b[i] * b[j]
            S[i, j] += size * size * b[i] * b[j]


@exact_inner
def _correct(P: Array, m: int, k0: float, k1: float, k2: float, variance: float) -> None:
    """P after a measurement of state m with these gains, in the Joseph form."""
    left = np.eye(3)
    left[0, m] -= k0
    left[1, m] -= k1
    left[2, m] -= k2
    k = np.array((k0, k1, k2))
    P[:] = left @ P @ left.T + variance * np.outer(k, k)


@exact_inner
def _correct_both(S: Array, m: int, k0: float, k1: float, k2: float, variance: float) -> None:
    """S after a measurement of state m with these gains."""
    P, shared = S[:, :3].copy(), S[m, 3]
    _correct(P, m, k0, k1, k2, variance)
    S[:, :3] = P
    S[0, 3] -= k0 * shared
    S[1, 3] -= k1 * shared
    S[2, 3] -= k2 * shared
