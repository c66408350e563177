"""Which axes of a vehicle its thrusters control, and what the others get in passing.

A layout of rank r controls r axes. Those come first that nothing else brings back: heave, yaw,
surge and sway; roll and pitch have the righting moment of the hull. Where only one of these two is
left (two thrusters dead), it is the one with the greater moment: they are righted alike, and what
the thrusters give the other one in passing is then the smaller. An axis that is left out is the
hull's: the law asks nothing of it, and none of the others is traded for it. What the thrusters do
to it in passing (a surge thruster below the centre of mass pitches the vehicle) is known, and is
part of the wrench that is asked for, so that an allocator of any kind can give it exactly.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvms_control.vehicle_data import thruster_limits
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix

Flags = NDArray[np.bool_]

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
FIRST = (2, 5, 0, 1)
"""Order in which axes are taken: those without a righting moment of their own come first."""
RIGHTED = (3, 4)  # files with numba kernels take it
"""Then these, the one with the greater moment first."""
INDEPENDENT = 0.05
"""Least singular value of the rows of the axes taken, each row of unit length in shares of the
limits: below it an axis would cost twenty times the thrust that it costs alone."""


@dataclass(frozen=True)
class ControlledAxes:
    """What the thrusters can do.

    Attributes:
        is_controlled: (6,) axes that the law controls.
        passing: (6, 6) wrench that the thrusters give with a wrench along the controlled axes:
            the identity for those, zero columns for the others.
        authority: (6,) greatest force or moment along each with the other controlled axes at zero,
            by the least-norm thrusts, in the weaker direction, N and N m; 0 where not controlled.
        lag: (6,) time constant of the slowest thruster that acts, s.
    """

    is_controlled: Flags
    passing: Array
    authority: Array
    lag: Array


def controlled_axes(matrix: Array, lower: Array, upper: Array, constants: Array) -> ControlledAxes:
    """The axes of a layout.

    Args:
        matrix: (6, m) wrench per newton, with the columns of thrusters that fail scaled down.
        lower: (m,) greatest thrusts astern, N, not above 0.
        upper: (m,) greatest ahead, N.
        constants: (m,) time constants of the thrusters, s.

    None is controlled where no thruster pushes.
    """
    limits = np.where(lower < 0.0, np.minimum(-lower, upper), upper)
    shares = matrix * limits
    taken = _independent(shares)
    inverse = np.zeros((limits.size, 6))
    authority, lag = np.zeros(6), np.zeros(6)
    if not taken:
        return ControlledAxes(np.zeros(6, dtype=np.bool_), np.zeros((6, 6)), authority, lag)
    inverse[:, taken] = _least_norm_inverse(shares[taken])
    used = np.abs(inverse)
    authority[taken] = 1.0 / used[:, taken].max(axis=0)
    acts = used > 1e-6 * np.maximum(used.max(axis=0), 1e-300)
    lag[taken] = np.max(acts * constants[:, None], axis=0)[taken]
    is_controlled = np.zeros(6, dtype=np.bool_)
    is_controlled[taken] = True
    passing = _product(shares, inverse)
    passing[taken] = np.eye(6)[taken]
    return ControlledAxes(is_controlled, passing, authority, lag)


def _least_norm_inverse(rows: Array) -> Array:
    """Right inverse (m, k) of independent rows (k, m) with the least norm: R^T (R R^T)^-1.

    By Gauss and Jordan, and not by a library: LAPACK's last bit depends on where its operands lie
    in memory, so that a run on the graph would not be that in the process bit for bit.
    """
    k = len(rows)
    table = np.hstack((_product(rows, rows.T), np.eye(k)))
    for i in range(k):
        pivot = i + int(np.argmax(np.abs(table[i:, i])))
        table[[i, pivot]] = table[[pivot, i]]
        table[i] = table[i] / table[i, i]
        for j in range(k):
            if j != i:
                table[j] = table[j] - table[j, i] * table[i]
    return _product(rows.T, table[:, k:])


def _product(one: Array, other: Array) -> Array:
    """Matrix product whose sums run in a fixed order."""
    out = np.zeros((one.shape[0], other.shape[1]))
    for k in range(one.shape[1]):
        out += one[:, k : k + 1] * other[k]
    return out


def _independent(shares: Array) -> list[int]:
    """Axes whose rows of thrust shares (6, m) are independent, in order of importance."""
    lengths = np.linalg.norm(shares, axis=1)
    rows = shares / np.maximum(lengths, 1e-300)[:, None]
    taken: list[int] = []
    for axis in (*FIRST, *sorted(RIGHTED, key=lambda each: -lengths[each])):
        if lengths[axis] <= 0.0:
            continue
        least = np.linalg.svd(rows[[*taken, axis]], compute_uv=False)[-1]
        if len(taken) < shares.shape[1] and least > INDEPENDENT:
            taken.append(axis)
    return sorted(taken)


def axes_of(vehicle: Vehicle, effectiveness: Array | None = None) -> ControlledAxes:
    """The axes of a vehicle, whose thrusters give a share (m,) of their commands (None: all)."""
    limits, _ = thruster_limits(vehicle)
    matrix = thruster_matrix(vehicle)
    if effectiveness is not None and effectiveness.size:
        matrix = matrix * effectiveness
    constants = np.array([thruster.time_constant_s for thruster in vehicle.thrusters])
    return controlled_axes(matrix, limits[0], limits[1], constants)
