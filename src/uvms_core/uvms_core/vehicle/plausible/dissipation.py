"""Does the hull's damping take energy from every motion, at the surge speeds that the file states?

At a surge speed u the resistance to a motion nu = (u, x) is D(u) nu and what is quadratic in x,
with D = L + |u| (P + Q_u): the linear matrix L, the products P of `hull.cross_terms` and the column
Q_u of the quadratic damping that multiplies |u| u. The power nu^T D nu that it takes is at least 0
for every x if and only if the symmetric part of D has no negative eigenvalue. D is linear in |u|,
so where that is true at both ends of a range of speeds, it is true between them. What is quadratic
in x takes power by itself where its matrix is diagonal; where it is not, the whole power is tried
in many directions, which finds, but does not prove. Munk's moment and all else that follows from
added mass is conservative and does not count here; the force of a fin never feeds energy.
"""

from collections.abc import Iterator

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.damping import (
    AXES,
    PRODUCTS,
    VELOCITIES,
    lift_matrix,
    linear_matrix,
    place_of,
    quadratic_matrix,
)
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.vehicle import Vehicle

ROUNDING = 1e-9
"""Negative power, as a part of the largest, that is rounding."""

DIRECTIONS = 2000
"""Directions of motion in which quadratic damping is tried."""

LARGEST = (0.1, 1.0, 10.0)
"""Sizes of these motions, m/s and rad/s."""


def check_dissipation(vehicle: Vehicle) -> Iterator[Finding]:
    """What of the hull's damping feeds energy, as errors."""
    hull = vehicle.hull
    for speed in hull.speeds_m_s:
        if (finding := _at_speed(hull, speed)) is not None:
            yield finding
            return
    quadratic = quadratic_matrix(hull)
    if (quadratic != np.diag(np.diag(quadratic))).any():
        yield from _quadratic(hull)


def damping_at(hull: Hull, speed: float) -> Array:
    """D (6, 6) at a surge speed, m/s, without the fins and what is quadratic in other motions."""
    column = np.zeros((6, 6))
    column[:, 0] = quadratic_matrix(hull)[:, 0]
    return linear_matrix(hull) + abs(speed) * (lift_matrix(hull) + column)


def _at_speed(hull: Hull, speed: float) -> Finding | None:
    matrix = damping_at(hull, speed)
    symmetric = 0.5 * (matrix + matrix.T)
    values, vectors = np.linalg.eigh(symmetric)
    if values[0] >= -ROUNDING * max(np.abs(values).max(), 1e-300):
        return None
    motion = vectors[:, 0]
    share = np.outer(motion, motion) * matrix
    i, j = np.unravel_index(int(np.argmin(share)), share.shape)
    how = ", ".join(f"{name} {x:+.2g}" for name, x in zip(VELOCITIES, motion, strict=True) if x)
    field, value = _entry(hull, int(i), int(j))
    return Finding(
        field,
        f"{value}: at {speed:g} m/s of surge the damping feeds {-values[0]:.3g} W into the motion"
        f" {how} (m/s, rad/s); damping must take energy at all speeds of hull.speeds_m_s ="
        f" {list(hull.speeds_m_s)}; entry {AXES[i]}{VELOCITIES[j]} of its matrix is"
        f" {matrix[i, j]:.4g}, opposite {matrix[j, i]:.4g}, between {matrix[i, i]:.4g} and"
        f" {matrix[j, j]:.4g} on the diagonal",
        is_error=True,
    )


def _entry(hull: Hull, i: int, j: int) -> tuple[str, str]:
    """Field that most of entry (i, j) of D comes from, and its value in words."""
    terms = hull.cross_terms
    for place in ((i, j), (j, i)):
        for name in PRODUCTS:
            given = None if terms is None else getattr(terms, name)
            if terms is None or given is None or place_of(name) != place:
                continue
            rest = -lift_matrix(hull)[place]
            less = (
                f", {rest:.4g} without the added mass's part" if terms.added_mass_included else ""
            )
            return f"hull.cross_terms.{name}", f"is {given:g}{less}"
    linear, quadratic = linear_matrix(hull), quadratic_matrix(hull)
    name, matrix = ("linear", linear) if linear[i, j] or j else ("quadratic", quadratic)
    return (
        f"hull.{name}_damping.{i}.{j}",
        f"row {i + 1}, column {j + 1} is {matrix[i, j]:g}",
    )


def _quadratic(hull: Hull) -> Iterator[Finding]:
    """The whole power at the ends of the range, in many directions of motion."""
    linear, quadratic, lift = linear_matrix(hull), quadratic_matrix(hull), lift_matrix(hull)
    directions = np.random.default_rng(0).normal(size=(DIRECTIONS, 6))
    directions /= np.abs(directions).max(axis=1)[:, None]
    pairs = np.concatenate([_in_plane(i, j) for i in range(6) for j in range(i)])
    for size in LARGEST:
        nu = size * np.concatenate([directions, pairs])
        nu[:, 0] = np.clip(nu[:, 0], -hull.speeds_m_s[1], hull.speeds_m_s[1])
        force = nu @ linear.T + (np.abs(nu) * nu) @ quadratic.T
        force += np.abs(nu[:, :1]) * (nu @ lift.T)
        power = np.einsum("ki,ki->k", nu, force)
        largest = np.einsum("ki,ki->k", np.abs(nu), np.abs(force))
        worst = int(np.argmin(power + ROUNDING * largest))
        if power[worst] < -ROUNDING * largest[worst]:
            yield _quadratic_finding(hull, nu[worst], float(power[worst]))
            return


def _in_plane(i: int, j: int) -> Array:
    """Directions (k, 6) of the motion along two axes."""
    angle, unit = np.linspace(0.0, 2.0 * np.pi, 181), np.eye(6)
    return np.outer(np.cos(angle), unit[i]) + np.outer(np.sin(angle), unit[j])


def _quadratic_finding(hull: Hull, nu: Array, power: float) -> Finding:
    matrix = quadratic_matrix(hull)
    share = nu[:, None] * matrix * (np.abs(nu) * nu)
    i, j = np.unravel_index(int(np.argmin(share)), share.shape)
    how = ", ".join(f"{name} {x:+.2g}" for name, x in zip(VELOCITIES, nu, strict=True) if x)
    return Finding(
        f"hull.quadratic_damping.{i}.{j}",
        f"row {i + 1}, column {j + 1} is {matrix[i, j]:g}: the damping feeds {-power:.3g} W into"
        f" the motion {how} (m/s, rad/s), and must take energy from every motion; its diagonal is"
        f" {matrix[i, i]:.4g} in row {i + 1} and {matrix[j, j]:.4g} in row {j + 1}",
        is_error=True,
    )
