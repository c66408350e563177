"""Where an axis of the tool is to point along a path, as a function of time."""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array


class Directions(NamedTuple):
    """A unit vector and its derivatives at k instants, in map_ned axes."""

    direction: Array  # (k, 3)
    rate: Array  # (k, 3) 1/s, across the direction
    acceleration: Array  # (k, 3) 1/s^2


def normalized(vectors: Array, rates: Array, accelerations: Array) -> Directions:
    """The direction d = v / |v| of moving vectors v (k, 3), which are not zero.

    With P = I - d d^T: |v| d_dot = P v_dot, and |v| d_ddot = v_ddot - 2 l_dot d_dot - l_ddot d, the
    length's derivatives being l_dot = d . v_dot and l_ddot = d . v_ddot + d_dot . v_dot.
    """
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    direction = vectors / length
    stretch = _dot(direction, rates)
    rate = (rates - stretch * direction) / length
    stretching = _dot(direction, accelerations) + _dot(rate, rates)
    bend = (accelerations - 2 * stretch * rate - stretching * direction) / length
    return Directions(direction, rate, bend)


def _dot(a: Array, b: Array) -> Array:
    return np.sum(a * b, axis=1, keepdims=True)
