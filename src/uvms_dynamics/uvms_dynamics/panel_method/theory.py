"""Added mass in closed form, and how it changes with the frame."""

import numpy as np
from scipy.special import elliprd

from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import skew


def in_frame(matrix: Array, position: Array, rotation: Array) -> Array:
    """Added mass (6, 6) of a body in a frame in which its own has the pose (position, rotation).

    X^T M X with X = [R^T, -R^T [p]x; 0, R^T], which maps a twist about the new origin, in the new
    axes, to the body's own (Fossen 2011, sec. 7.5.4).
    """
    X = np.zeros((6, 6))
    X[:3, :3] = X[3:, 3:] = rotation.T
    X[:3, 3:] = -rotation.T @ skew(position)
    return X.T @ matrix @ X


def ellipsoid_added_mass(axes: Array, density: float) -> Array:
    """Added mass (6, 6) of an ellipsoid about its centre from its half axes (3,), m.

    Lamb, Hydrodynamics (1932), art. 114 and 115. With alpha_i = 2/3 abc R_D(the other two squared,
    own squared), Carlson's form of Lamb's integrals: rho V alpha / (2 - alpha) in translation, and
    rho V/5 (b^2-c^2)^2 (gamma-beta) / (2(b^2-c^2) + (b^2+c^2)(beta-gamma)) about the x axis.
    """
    water = density * 4.0 / 3.0 * np.pi * np.prod(axes)
    squares = np.asarray(axes, dtype=float) ** 2
    alpha = np.array([_lamb_integral(np.roll(squares, -i)) for i in range(3)])
    rotation = [_about(np.roll(squares, -i), np.roll(alpha, -i)) for i in range(3)]
    return water * np.diag([*(alpha / (2.0 - alpha)), *rotation])


def _lamb_integral(squares: Array) -> float:
    own, second, third = squares
    return float(2.0 / 3.0 * np.sqrt(squares.prod()) * elliprd(second, third, own))


def _about(squares: Array, alpha: Array) -> float:
    """Rotation factor about the first axis, m^2; zero where the section is a circle."""
    (_, b, c), (_, beta, gamma) = squares, alpha
    if abs(b - c) < 1e-12 * (b + c):
        return 0.0
    below = 2.0 * (b - c) + (b + c) * (beta - gamma)
    return float((b - c) ** 2 * (gamma - beta) / below / 5.0)


def slender_cylinder_added_mass(radius: float, length: float, density: float) -> Array:
    """Strip theory (6, 6) for a cylinder along x about its middle: an upper bound across it.

    rho pi r^2 l across, rho pi r^2 l^3 / 12 in rotation, none along and about the axis: water that
    flows round the ends is left out (Fossen 2011, sec. 6.4).
    """
    water = density * np.pi * radius**2 * length
    turn = water * length**2 / 12.0
    return np.diag([0.0, water, water, 0.0, turn, turn])
