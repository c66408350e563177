"""Derivatives of measured signals: a Kalman filter whose highest derivative is a random walk.

Differences of neighbouring samples amplify noise by 1/dt, and a fixed low-pass must be tuned to
each sensor. The tracking filter is the best linear compromise for a stated noise and a stated jerk
J: with x = (y, y', .., y^(k-1)),

    x(t + dt) = F x,  F_ij = dt^(j-i) / (j-i)!,   Q = J^2 * integral of (F(s) e_k)(F(s) e_k)^T,

and any of the lower derivatives may be measured as well (an encoder's rate, say). Its estimate has
no lag while y^(k-1) is constant. All channels of a filter share one noise and so one covariance.
"""

from math import factorial

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel

VARIANCE_FLOOR = 1e-18
"""Keeps the innovation invertible when perfect measurements are fed in."""


class TrackingFilter:
    """Value and derivatives of several channels with the same noise.

    Args:
        order: number of derivatives kept, the value included (k).
        jerk: rms change of the highest derivative within one second, J.
    """

    def __init__(self, order: int, jerk: float) -> None:
        self._order = order
        self._density = jerk**2
        self._x: Array | None = None  # (k, channels)
        self._P = np.zeros((order, order))
        self._measured = order  # value and derivatives of the first measurement
        self._dt = 0.0  # of these
        self._F = np.eye(order)
        self._Q = np.zeros((order, order))

    @property
    def jerk(self) -> float:
        """J; it may be changed between two steps."""
        return float(np.sqrt(self._density))

    @jerk.setter
    def jerk(self, jerk: float) -> None:
        self._density = jerk**2
        if self._dt > 0.0:
            self._Q = self._density * walk(self._order, self._dt)
        else:  # nothing but the first measurement is known
            np.fill_diagonal(self._P[self._measured :, self._measured :], self._density)

    @property
    def covariance(self) -> Array:
        """Of the error of value and derivatives, (k, k), the same for every channel."""
        return self._P

    def step(self, dt: float, measured: Array, variances: Array) -> Array:
        """Estimate (k, channels) after dt, given the value and its first derivatives (m, channels).

        The first call starts from the measurement, with all higher derivatives zero.

        Args:
            dt: since the last call, s.
            measured: (m, channels), m <= k.
            variances: (m,) of their noise.
        """
        if self._x is None:
            self._x = self._start(measured, variances)
            return self._x
        if dt != self._dt:
            self._dt, self._F = dt, transition(self._order, dt)
            self._Q = self._density * walk(self._order, dt)
        self._x, self._P = follow(self._x, self._P, self._F, self._Q, measured, variances)
        return self._x

    def _start(self, measured: Array, variances: Array) -> Array:
        self._measured = count = len(variances)
        x = np.zeros((self._order, measured.shape[1]))
        x[:count] = measured
        self._P = self._density * np.eye(self._order)
        self._P[:count, :count] = np.diag(np.maximum(variances, VARIANCE_FLOOR))
        return x


@exact_kernel
def follow(
    x: Array, P: Array, F: Array, Q: Array, measured: Array, variances: Array
) -> tuple[Array, Array]:
    """The next estimate and its covariance.

    The noises are independent, so that the measured derivatives are taken in one after the other,
    each in the Joseph form: no matrix is solved for.
    """
    order, channels = x.shape
    estimate, left = np.zeros((order, channels)), np.zeros((order, order))
    for i in range(order):
        for j in range(i, order):
            for k in range(channels):
                estimate[i, k] += F[i, j] * x[j, k]
            for k in range(order):
                left[i, k] += F[i, j] * P[j, k]
    covariance = Q.copy()
    for i in range(order):
        for k in range(order):
            for j in range(k, order):
                covariance[i, k] += left[i, j] * F[k, j]
    for m in range(measured.shape[0]):
        _take_in(estimate, covariance, m, measured[m], max(variances[m], VARIANCE_FLOOR), left)
    return estimate, covariance


@exact_kernel
def _take_in(x: Array, P: Array, m: int, measured: Array, variance: float, scratch: Array) -> None:
    """Correct x and P in place by a measurement of derivative m, in the Joseph form."""
    order, total = x.shape[0], P[m, m] + variance
    gain = P[:, m] / total
    for k in range(x.shape[1]):
        innovation = measured[k] - x[m, k]
        for i in range(order):
            x[i, k] += gain[i] * innovation
    for i in range(order):
        for j in range(order):
            scratch[i, j] = P[i, j] - gain[i] * P[m, j]
    for i in range(order):
        for j in range(i, order):
            P[i, j] = scratch[i, j] - scratch[i, m] * gain[j] + gain[i] * variance * gain[j]
            P[j, i] = P[i, j]


def transition(order: int, dt: float) -> Array:
    """F (k, k) of value and derivatives over dt s."""
    F = np.zeros((order, order))
    for i in range(order):
        for j in range(i, order):
            F[i, j] = dt ** (j - i) / factorial(j - i)
    return F


def walk(order: int, dt: float) -> Array:
    """Covariance (k, k) of a unit random walk of the last derivative, integrated over dt."""
    Q = np.zeros((order, order))
    for i in range(order):
        for j in range(order):
            a, b = order - 1 - i, order - 1 - j
            Q[i, j] = dt ** (a + b + 1) / ((a + b + 1) * factorial(a) * factorial(b))
    return Q
