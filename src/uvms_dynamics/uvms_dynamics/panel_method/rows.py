"""Rows of an added-mass matrix as the vehicle file expects them."""

from itertools import product

import numpy as np
from pydantic import TypeAdapter, ValidationError

from uvms_core.signals import Array
from uvms_core.vehicle.parts import AddedMass
from uvms_dynamics.panel_method.errors import PanelMethodError

DIGITS = (5, 7, 9, 12, 17)
"""Significant digits to try; a matrix of low rank stays semidefinite only with many."""

ZERO_BELOW = (1e-5, 1e-8)
"""Thresholds to try: entries below this part of sqrt(A_ii A_jj) become zero.

Both are far below the method's error.
"""


def rounded_rows(matrix: Array) -> list[list[float]]:
    """Rows with as few digits as the vehicle file's check of the matrix allows."""
    check: TypeAdapter[object] = TypeAdapter(AddedMass)
    fault: ValidationError | None = None
    for digits, threshold in product(DIGITS, ZERO_BELOW):
        rows = [
            [float(f"{v:.{digits}g}") for v in row]
            for row in _without_small_entries(matrix, threshold)
        ]
        try:
            check.validate_python(rows)
        except ValidationError as error:
            fault = error
            continue
        return rows
    raise PanelMethodError(f"not an added mass: {fault}")


def _without_small_entries(matrix: Array, threshold: float) -> Array:
    diagonal = np.diag(matrix)
    size = np.sqrt(np.maximum(diagonal, threshold**2 * diagonal.max()))
    return np.where(np.abs(matrix) < threshold * np.outer(size, size), 0.0, matrix)


def added_mass_yaml(matrix: Array, indent: str = "") -> str:
    """The matrix as the entry `added_mass:` of a vehicle file, one row per line."""
    texts = [[_number(value) for value in row] for row in rounded_rows(matrix)]
    width = max(len(text) for row in texts for text in row)
    lines = ["  - [" + ", ".join(text.rjust(width) for text in row) + "]" for row in texts]
    return "\n".join(indent + line for line in ["added_mass:", *lines])


def _number(value: float) -> str:
    """A number in a form that YAML 1.1 readers take as one: 1e-05 would be text, 1.0e-05 is not."""
    text = repr(value + 0.0)
    mantissa, exponent, power = text.partition("e")
    return text if not exponent or "." in mantissa else f"{mantissa}.0e{power}"
