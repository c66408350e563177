"""Base class and vector types of the vehicle file, with their physical checks."""

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, BeforeValidator, WrapValidator

from uvms_core.config import Config

Vector3 = tuple[float, float, float]
Vector6 = tuple[float, float, float, float, float, float]
Rows = tuple[tuple[float, ...], ...]

_TOLERANCE = 1e-9  # relative; values in files are rounded decimals or full doubles

PRINTED = 1e-3
"""Relative difference that is taken for rounding in a printed table, which has three digits or
more, such as 0.707 for a half right angle, or 10.774 opposite 10.775. It is evened out."""

_EXACT_UNIT = 1e-6  # a length as near to one as this is left as it is


class Part(Config):
    """Base of every section of the vehicle file."""


def or_keyword(*words: str) -> WrapValidator:
    """Let a field hold one of these keywords in the file; the loader replaces it by a value."""

    def validate(value: Any, handler: Callable[[Any], Any]) -> Any:
        if not isinstance(value, str):
            return handler(value)
        if value not in words:
            allowed = " or ".join(repr(each) for each in words)
            raise ValueError(f"must be a value or the word {allowed}")
        return value

    return WrapValidator(validate)


def _square(size: int) -> BeforeValidator:
    """A list of `size` numbers is the diagonal of a matrix of that size."""

    def expand(value: Any) -> Any:
        if not isinstance(value, Sequence) or isinstance(value, str):
            return value
        if len(value) != size:
            raise ValueError(f"needs {size} diagonal values or {size} rows, has {len(value)}")
        if any(isinstance(item, Sequence) and not isinstance(item, str) for item in value):
            return value
        return [[x if i == j else 0.0 for j in range(size)] for i, x in enumerate(value)]

    return BeforeValidator(expand)


def _symmetric(rows: Rows) -> np.ndarray:
    """The matrix, with entries that differ by the rounding of print replaced by their mean."""
    lengths = {len(row) for row in rows}
    if lengths != {len(rows)}:
        raise ValueError(f"needs {len(rows)} values in each row, has rows of {sorted(lengths)}")
    matrix = np.array(rows)
    apart = np.abs(matrix - matrix.T)
    rounding = _TOLERANCE * max(np.abs(matrix).max(), 1.0)
    allowed = np.maximum(PRINTED * np.maximum(np.abs(matrix), np.abs(matrix.T)), rounding)
    if (apart > allowed).any():
        i, j = np.unravel_index(int(np.argmax(apart / allowed)), apart.shape)
        share = apart[i, j] / max(abs(matrix[i, j]), abs(matrix[j, i]))
        raise ValueError(
            f"must be symmetric: row {i + 1}, column {j + 1} is {matrix[i, j]:g} and row {j + 1},"
            f" column {i + 1} is {matrix[j, i]:g}; they differ by {apart[i, j]:.4g}, which is"
            f" {share:.2%}; up to {PRINTED:.1%} is taken for rounding"
        )
    return matrix if apart.max() <= rounding else 0.5 * (matrix + matrix.T)


def _is_inertia(rows: Rows) -> Rows:
    matrix = _symmetric(rows)
    moments = np.linalg.eigvalsh(matrix)
    if moments[0] <= 0.0:
        raise ValueError(f"must be positive definite; its least principal moment is {moments[0]:g}")
    if moments[2] > (moments[0] + moments[1]) * (1.0 + _TOLERANCE):
        text = ", ".join(f"{moment:g}" for moment in moments)
        raise ValueError(
            f"no body has principal moments {text}: the largest exceeds the others' sum"
        )
    return _rows(matrix)


def _is_added_mass(rows: Rows) -> Rows:
    matrix = _symmetric(rows)
    values = np.linalg.eigvalsh(matrix)
    if values[0] < -_TOLERANCE * max(values[-1], 1.0):
        raise ValueError(f"must be positive semidefinite; its least eigenvalue is {values[0]:g}")
    return _rows(matrix)


def _rows(matrix: np.ndarray) -> Rows:
    return tuple(tuple(row) for row in matrix.tolist())


def _is_unit(vector: Vector3) -> Vector3:
    length = math.hypot(*vector)
    if abs(length - 1.0) > PRINTED:
        raise ValueError(
            f"must be a unit vector; its length is {length:g}, and up to {PRINTED:g} off is taken"
            " for rounding"
        )
    if abs(length - 1.0) <= _EXACT_UNIT:
        return vector
    x, y, z = vector
    return x / length, y / length, z / length


Inertia = Annotated[Rows, _square(3), AfterValidator(_is_inertia)]
"""(3, 3) kg m^2, positive definite, principal moments within the triangle inequality; symmetric up
to the rounding of print."""

AddedMass = Annotated[Rows, _square(6), AfterValidator(_is_added_mass)]
"""(6, 6) symmetric positive semidefinite, order (X Y Z K M N), kg, kg m and kg m^2."""

UnitVector = Annotated[Vector3, AfterValidator(_is_unit)]
"""(3,) of length one; up to the rounding of print, which is evened out."""


def unique_names(parts: Sequence[Any], what: str) -> None:
    """Raise ValueError if two parts share a name."""
    names = [part.name for part in parts]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"{what} names must differ; used more than once: {', '.join(twice)}")
