"""Swings of the freely floating vehicle about its equilibrium."""

import math
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.statics import first_moment
from uvms_dynamics.kernels import mass_matrix
from uvms_dynamics.model.vehicle_table import build_model


class Periods(NamedTuple):
    """Natural periods, s; infinite where nothing rights the vehicle."""

    roll_s: float
    pitch_s: float


def natural_periods(vehicle: Vehicle, q: Array) -> Periods:
    """Undamped periods of small swings, the joints held at q (n,), rad.

    About the equilibrium down is k = P / |P|, and a small turn d rights itself with the moment
    -K d, K = |P| (E - k k^T); so M x'' + diag(0, K) x = 0 with the mass matrix M (6, 6) of vehicle,
    arm and added mass about the body origin, which is free to move. Of the two swings the one that
    turns more about the body's x axis is called roll.
    """
    moment = first_moment(vehicle, q)
    size = float(np.linalg.norm(moment))
    if size == 0.0:
        return Periods(math.inf, math.inf)
    stiffness = np.zeros((6, 6))
    stiffness[3:, 3:] = size * np.eye(3) - np.outer(moment, moment) / size
    mass = mass_matrix(build_model(vehicle), np.ascontiguousarray(q, dtype=float))[:6, :6]
    squares, modes = _modes(mass, stiffness)
    first, second = (2.0 * math.pi / math.sqrt(square) for square in squares)
    about_x = np.abs(modes[3]) / np.linalg.norm(modes[3:], axis=0)
    return Periods(first, second) if about_x[0] >= about_x[1] else Periods(second, first)


def _modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """The two greatest eigenvalues (2,) of M^-1 K, 1/s^2, and their vectors (6, 2).

    By M = L L^T it is the symmetric problem of L^-1 K L^-T.
    """
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    values, vectors = np.linalg.eigh(inverse @ stiffness @ inverse.T)
    return values[-2:], (inverse.T @ vectors)[:, -2:]
