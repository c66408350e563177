"""Rotation vectors along a motion: angular velocity and acceleration, many at once.

R(t) = exp(phi(t)) R0 with phi in the axes of the world has the angular velocity J(phi) phi_dot in
these axes; J is the left Jacobian of SO(3) (Sola, Deray, Atchuthan 2018, eq. 145 and 146).
"""

import numpy as np
from numpy.linalg import norm

from uvms_core.signals import Array

SMALL_RAD = 1e-2
"""Below it series to the fourth power, exact to 1e-13, replace quotients that would cancel."""


def angular_motion(phi: Array, rate: Array, acceleration: Array) -> tuple[Array, Array]:
    """Angular velocity and acceleration (k, 3) of rotation vectors (k, 3) and their derivatives.

    omega = J phi_dot; omega_dot = J phi_ddot + J_dot phi_dot.
    """
    return _jacobian(phi, rate), _jacobian(phi, acceleration) + _jacobian_rate(phi, rate)


def vector_motion(phi: Array, omega: Array, alpha: Array) -> tuple[Array, Array]:
    """The derivatives of rotation vectors (k, 3), |phi| < 2 pi, with this angular motion (k, 3)."""
    rate = _inverse_jacobian(phi, omega)
    return rate, _inverse_jacobian(phi, alpha - _jacobian_rate(phi, rate))


def _jacobian(phi: Array, vector: Array) -> Array:
    """J(phi) v = v + a phi x v + b phi x (phi x v)."""
    a, b = _coefficients(norm(phi, axis=1, keepdims=True))
    once = np.cross(phi, vector)
    return vector + a * once + b * np.cross(phi, once)


def _inverse_jacobian(phi: Array, vector: Array) -> Array:
    """J^-1(phi) v = v - phi x v / 2 + c phi x (phi x v)."""
    angle = norm(phi, axis=1, keepdims=True)
    small = angle < SMALL_RAD
    safe = np.where(small, 1.0, angle)
    c = np.where(small, 1 / 12 + angle**2 / 720, 1 / safe**2 - 1 / (2 * safe * np.tan(0.5 * safe)))
    once = np.cross(phi, vector)
    return vector - 0.5 * once + c * np.cross(phi, once)


def _jacobian_rate(phi: Array, rate: Array) -> Array:
    """J_dot phi_dot: the part of the angular acceleration that comes from the rate alone."""
    angle = norm(phi, axis=1, keepdims=True)
    _, b = _coefficients(angle)
    a_slope, b_slope = _coefficient_slopes(angle)
    turning = np.sum(phi * rate, axis=1, keepdims=True)
    once = np.cross(phi, rate)
    slopes = a_slope * turning * once + b_slope * turning * np.cross(phi, once)
    return slopes + b * np.cross(rate, once)


def _coefficients(angle: Array) -> tuple[Array, Array]:
    """The factors a = (1 - cos x) / x^2 and b = (x - sin x) / x^3 of J."""
    small = angle < SMALL_RAD
    x = np.where(small, 1.0, angle)
    a = np.where(small, 1 / 2 - angle**2 / 24, 2 * np.sin(0.5 * x) ** 2 / x**2)
    b = np.where(small, 1 / 6 - angle**2 / 120, (x - np.sin(x)) / x**3)
    return a, b


def _coefficient_slopes(angle: Array) -> tuple[Array, Array]:
    """The derivatives a' / x and b' / x."""
    small = angle < SMALL_RAD
    x = np.where(small, 1.0, angle)
    sine, cosine = np.sin(x), np.cos(x)
    a = np.where(small, -1 / 12 + angle**2 / 180, (x * sine - 2 * (1 - cosine)) / x**4)
    b = np.where(small, -1 / 60 + angle**2 / 1260, (3 * sine - x * cosine - 2 * x) / x**5)
    return a, b
