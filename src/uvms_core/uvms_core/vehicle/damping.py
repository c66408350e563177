"""Damping of the hull: what opposes its motion through the water, as 6x6 matrices and products.

Order X Y Z K M N against u v w p q r. Damping matrices are written positive: the force is -D nu.
The resistance of the hull, without its fins, is

    D(nu) nu = (L + Q diag(|nu|) + |u| P) nu

with the linear matrix L, the quadratic matrix Q, entry (i, j) with |nu_j| nu_j, and P of the
products with the surge speed. These come with |u|: a hull that goes astern is damped as well.
"""

from typing import Annotated, Any

import numpy as np
from pydantic import Field, PlainSerializer, WrapValidator

from uvms_core.signals import Array
from uvms_core.vehicle.parts import Part, Rows, Vector6

AXES = "XYZKMN"
VELOCITIES = "uvwpqr"


def _diagonal_or_rows(value: Any, handler: Any) -> Any:
    """6 values stay what they are, the diagonal, so that each has its own path in the file."""
    is_list = isinstance(value, list | tuple)
    if is_list and any(isinstance(row, list | tuple) for row in value):
        return _checked(handler(value))
    if is_list and len(value) == 6:
        rows = handler([[x if i == j else 0.0 for j in range(6)] for i, x in enumerate(value)])
        _checked(rows)
        return tuple(rows[i][i] for i in range(6))
    if is_list:
        raise ValueError(f"needs 6 diagonal values or 6 rows, has {len(value)}")
    return handler(value)


def _checked(rows: Rows) -> Rows:
    lengths = sorted({len(row) for row in rows})
    if len(rows) != 6 or lengths != [6]:
        raise ValueError(f"needs 6 rows of 6 values, has {len(rows)} rows of {lengths}")
    if min(rows[i][i] for i in range(6)) < 0.0:
        raise ValueError("damping is written positive: every value must be >= 0")
    return rows


Damping = Annotated[Rows, WrapValidator(_diagonal_or_rows), PlainSerializer(lambda value: value)]
"""(6, 6), its diagonal >= 0, or the 6 values of a diagonal one, which stay 6 values.

Read it by `linear_matrix` and `quadratic_matrix`.
"""


class CrossTerms(Part):
    """Products with the surge speed u of a slender hull with fins: Y = Y_uv u v + Y_ur u r ...

    Signs are those of published coefficients (SNAME 1950, Gertler and Hagen 1967): forces and
    moments ON the hull, so Y_uv is negative for a hull that is damped, unlike the damping matrices.
    A coefficient that is not given adds nothing.
    """

    added_mass_included: bool = Field(
        default=True,
        description="whether the coefficients contain what follows from the added mass, such as"
        " Munk's moment in N_uv, as tables of published coefficients do; it is taken off, since the"
        " model has it already; false: lift alone",
    )
    Y_uv: float | None = Field(default=None, description="sway force of sway, kg/m")
    Y_ur: float | None = Field(default=None, description="sway force of yaw rate, kg")
    N_uv: float | None = Field(default=None, description="yaw moment of sway, kg")
    N_ur: float | None = Field(default=None, description="yaw moment of yaw rate, kg m")
    Z_uw: float | None = Field(default=None, description="heave force of heave, kg/m")
    Z_uq: float | None = Field(default=None, description="heave force of pitch rate, kg")
    M_uw: float | None = Field(default=None, description="pitch moment of heave, kg")
    M_uq: float | None = Field(default=None, description="pitch moment of pitch rate, kg m")
    K_up: float | None = Field(default=None, description="roll moment of roll rate, kg m")


PRODUCTS = tuple(name for name in CrossTerms.model_fields if "_u" in name)
"""Names of the coefficients: the force's axis, then the two velocities."""


def linear_matrix(hull: Any) -> Array:
    """L (6, 6), N per m/s and N m per rad/s."""
    return _matrix(hull.linear_damping)


def quadratic_matrix(hull: Any) -> Array:
    """Q (6, 6), N per (m/s)^2 and N m per (rad/s)^2."""
    return _matrix(hull.quadratic_damping)


def _matrix(values: Rows | Vector6) -> Array:
    array = np.array(values, dtype=float)
    return array if array.ndim == 2 else np.diag(array)


def lift_matrix(hull: Any) -> Array:
    """P (6, 6): the products with |u|, without what the added mass gives, written positive."""
    matrix = np.zeros((6, 6))
    if (terms := hull.cross_terms) is None:
        return matrix
    inertial = added_mass_products(np.array(hull.added_mass))
    for name in PRODUCTS:
        if (coefficient := getattr(terms, name)) is not None:
            i, j = place_of(name)
            matrix[i, j] = terms.added_mass_included * inertial[i, j] - coefficient
    return matrix


def lift_alone(hull: Any) -> CrossTerms | None:
    """The products of a hull without what its added mass gives: they stay when that changes."""
    if (terms := hull.cross_terms) is None or not terms.added_mass_included:
        return hull.cross_terms
    lift, given = lift_matrix(hull), [name for name in PRODUCTS if getattr(terms, name) is not None]
    values = {name: float(-lift[place_of(name)]) for name in given}
    return CrossTerms(added_mass_included=False, **values)


def is_coupled(hull: Any) -> bool:
    """Whether the damping of one axis depends on the motion along another, other than surge."""
    tables = hull.linear_damping, hull.quadratic_damping
    return hull.cross_terms is not None or any(np.ndim(table) == 2 for table in tables)


def place_of(name: str) -> tuple[int, int]:
    """Row and column of a coefficient such as N_uv: (5, 1)."""
    return AXES.index(name[0]), VELOCITIES.index(name[3])


def added_mass_products(added_mass: Array) -> Array:
    """Coefficients (6, 6) of u nu_j in the forces of C_A(nu) nu ON the hull, j = v w p q r.

    With M_A diagonal: N_uv = -(Y_vdot - X_udot), Munk's moment, and Y_ur = X_udot.
    """
    products = np.zeros((6, 6))
    unit = np.eye(6)
    for j in range(1, 6):
        both = kirchhoff(added_mass, unit[0] + unit[j])
        products[:, j] = -(both - kirchhoff(added_mass, unit[0]) - kirchhoff(added_mass, unit[j]))
    return products


def kirchhoff(added_mass: Array, nu: Array) -> Array:
    """C_A(nu) nu (6,) = (omega x p, omega x h + v x p) with (p, h) = M_A nu."""
    p, h = np.split(added_mass @ nu, 2)
    v, omega = nu[:3], nu[3:]
    return np.concatenate([np.cross(omega, p), np.cross(omega, h) + np.cross(v, p)])
