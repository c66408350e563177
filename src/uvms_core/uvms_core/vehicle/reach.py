"""Which ways thrusters can push along one axis alone, when some of them do not reverse."""

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array

CLOSE = 1e-6
"""Part of an axis that counts as missed: directions are printed with six digits."""


def reached_ways(matrix: Array, lower: Array, upper: Array) -> NDArray[np.bool_]:
    """Whether thrusts give a wrench along +axis (row 0) and -axis (row 1) alone: bool (2, 6).

    matrix (6, m): wrench of one newton of each thruster, in units that make its entries alike;
    lower <= 0 <= upper (m,): limits, N. How great the wrench can be does not matter, so that the
    thrusts that it takes form a cone: free for thrusters that reverse, one-sided for the others.
    """
    cone = _cone(matrix, lower, upper)
    result = np.empty((2, 6), dtype=np.bool_)
    for axis, unit in enumerate(np.eye(6)):
        result[0, axis], result[1, axis] = _is_in(cone, unit), _is_in(cone, -unit)
    return result


def _cone(matrix: Array, lower: Array, upper: Array) -> Array:
    """Columns of which every reachable wrench is a sum with factors >= 0."""
    return np.hstack([matrix[:, upper > 0.0], -matrix[:, lower < 0.0]])


def _is_in(cone: Array, wrench: Array) -> bool:
    from scipy.optimize import nnls  # half a second, only where a thruster does not reverse

    if cone.shape[1] == 0:
        return False
    _, missed = nnls(cone, wrench)
    return bool(missed <= CLOSE)


def one_way_texts(matrix: Array, lower: Array, upper: Array, names: tuple[str, ...]) -> list[str]:
    """What is said of axes that can be pushed one way alone, or neither: `heave (only +)`.

    Axes outside the span of the thrusters are not among them. Arguments as of `reached_ways`, and
    the names of the axes.
    """
    if ((lower < 0.0) & (upper > 0.0)).all():
        return []
    ways, both = reached_ways(matrix, lower, upper), reached_ways(matrix, -upper - 1.0, upper + 1.0)
    texts = []
    for axis, name in enumerate(names):
        ahead, astern = ways[:, axis]
        if both[0, axis] and not (ahead and astern):
            texts.append(f"{name} (only {'+' if ahead else '-'})" if ahead or astern else name)
    return texts
