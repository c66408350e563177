"""Slopes and second derivatives at the points of a curve, for quintic segments that join in C2.

Given the value, the slope m and the second derivative a at both ends, one polynomial of fifth
degree is left for a segment; segments that share them at a point join with continuous acceleration.
What is chosen here are m and a, from the points around:

- *Smooth data*: those of the quartic through five neighbouring points, which are exact to the
  fourth and third order of the spacing; a circle stays a circle. The curve rests at its ends, so
  that the points that are missing there are the end itself, at the spacing of its segment.
- *Where that would overshoot*: at most `SAFE_SLOPE` of the slower of the two mean rates beside the
  point (zero where they differ in sign), and a = 0. Two such points have a monotone segment between
  them whatever their spacing is.

Whether a segment overshoots is read, axis by axis, from its Bernstein polygon, within whose hull
the segment lies (Farin 2002, Curves and Surfaces for CAGD, ch. 5): where the data rise or fall
through it and its neighbours the polygon must do so, too; beside a turning point of the data it may
leave the range of its two points by `EXCURSION` of the smaller neighbouring step.
"""

from collections.abc import Callable

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from uvms_core.signals import Array

SAFE_SLOPE = 1.25
"""Over the mean rate s of a segment: with a = 0 the middle edge of its polygon,
h (s - 2/5 (m0 + m1)), is then not negative."""
EXCURSION = 0.5
"""A parabola that turns inside a segment leaves its range by at most an eighth of the smaller
neighbouring step, and its polygon by 0.15 of it: this leaves room for coarse and uneven points."""
REACH = 2
"""Points on either side from which the slope of a point is taken."""

Ends = tuple[Array, Array, Array, Array]
"""Slope and second derivative (k, d) at the beginning of each of k segments, and at its end."""


def moving_stretches(standing: NDArray[np.bool_]) -> list[slice]:
    """Points (first to last) of each run of segments that are not `standing` (n - 1,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[True], standing, [True]]).astype(int)))
    return [slice(first, last + 1) for first, last in edges.reshape(-1, 2).tolist()]


def with_rest(times: Array) -> Array:
    """The times (n,) with two more before and after, at the spacing of the end's segment."""
    first, last = times[1] - times[0], times[-1] - times[-2]
    before = times[0] - first * np.arange(REACH, 0, -1)
    return np.concatenate([before, times, times[-1] + last * np.arange(1, REACH + 1)])


def windows(values: Array) -> Array:
    """Five rows around each of n points, (n, 5, ...), of `values` (n + 4, ...)."""
    return np.moveaxis(sliding_window_view(values, 2 * REACH + 1, axis=0), -1, 1)


def quartic_derivatives(times: Array, values: Array) -> tuple[Array, Array]:
    """Slope and second derivative (n, d) at the third of five points, of the quartic through them.

    Newton's form about the third point, with the divided differences of the five in order.

    Args:
        times: (n, 5) s, increasing.
        values: (n, 5, d).
    """
    first, second, third, fourth = _divided_differences(times, values)
    to_1, to_3, to_0 = (times[:, 2:3] - times[:, k : k + 1] for k in (1, 3, 0))
    slope = first[:, 1] + to_1 * (second[:, 1] + to_3 * (third[:, 0] + to_0 * fourth[:, 0]))
    products = to_1 * to_3 + to_1 * to_0 + to_3 * to_0
    bend = second[:, 1] + (to_1 + to_3) * third[:, 0] + products * fourth[:, 0]
    return slope, 2.0 * bend


def _divided_differences(times: Array, values: Array) -> list[Array]:
    """Of first to fourth order, (n, 4, d) to (n, 1, d)."""
    table = [values]
    for order in range(1, 2 * REACH + 1):
        gaps = times[:, order:] - times[:, :-order]
        table.append(np.diff(table[-1], axis=1) / gaps[:, :, None])
    return table[1:]


def kept_in_shape(
    times: Array,
    steps: Array,
    derivatives: tuple[Array, Array],
    ends: Callable[[Array, Array], Ends] | None = None,
) -> tuple[Array, Array]:
    """Slopes and second derivatives (n, d) with which no segment overshoots, zero at both ends.

    Points are made safe where a segment beside them overshoots, until none does.

    Args:
        times: (n,) s.
        steps: (n - 1, d) from each point to the next.
        derivatives: slopes and second derivatives (n, d) of smooth data.
        ends: what those of the points are in the coordinates of their segments; none: the same.
    """
    ends = ends or _same_coordinates
    spacing = np.diff(times)[:, None]
    slope, second = (values.copy() for values in derivatives)
    slope[[0, -1]] = second[[0, -1]] = 0.0
    safe = np.zeros(slope.shape, dtype=np.bool_)
    safe[[0, -1]] = True
    limited = _safe_slopes(spacing, steps)
    while True:
        bad = overshoots(spacing, steps, ends(slope, second))
        beside = np.zeros_like(safe)
        beside[:-1] |= bad
        beside[1:] |= bad
        new = beside & ~safe
        if not new.any():
            return slope, second
        slope[new], second[new] = limited[new], 0.0
        safe |= new


def _same_coordinates(slope: Array, second: Array) -> Ends:
    return slope[:-1], second[:-1], slope[1:], second[1:]


def _safe_slopes(spacing: Array, steps: Array) -> Array:
    """Slopes (n, d): the weighted harmonic mean of Fritsch and Butland (1984), limited."""
    rate = steps / spacing
    before, after = rate[:-1], rate[1:]
    left, right = 2 * spacing[1:] + spacing[:-1], spacing[1:] + 2 * spacing[:-1]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        mean = (left + right) / (left / before + right / after)
    slower = np.minimum(np.abs(before), np.abs(after))
    slope = np.zeros((len(steps) + 1, steps.shape[1]))
    slope[1:-1] = np.where(
        before * after > 0.0, np.clip(mean, -SAFE_SLOPE * slower, SAFE_SLOPE * slower), 0.0
    )
    return slope


def polygons(spacing: Array, steps: Array, ends: Ends) -> Array:
    """Bernstein points (6, k, d) of quintic segments, from 0 to `steps` (k, d)."""
    m0, a0, m1, a1 = ends
    h, h2 = spacing / 5, spacing**2 / 20
    inner = h * m0, 2 * h * m0 + h2 * a0, steps - 2 * h * m1 + h2 * a1, steps - h * m1
    return np.stack([np.zeros_like(steps), *inner, steps])


def overshoots(spacing: Array, steps: Array, ends: Ends) -> NDArray[np.bool_]:
    """Whether each segment (k, d) goes beyond what its points and the neighbouring steps allow."""
    polygon = polygons(spacing, steps, ends)
    edges = np.diff(polygon, axis=0)
    rest = np.zeros((1, steps.shape[1]))
    before, after = np.vstack([rest, steps[:-1]]), np.vstack([steps[1:], rest])
    around = np.stack([before, steps, after])
    rounding = 1e-9 * np.abs(steps)
    rises, falls = np.all(around >= 0.0, axis=0), np.all(around <= 0.0, axis=0)
    allowed = EXCURSION * np.minimum(np.abs(before), np.abs(after)) + rounding
    above = polygon.max(axis=0) - np.maximum(steps, 0.0)
    below = np.minimum(steps, 0.0) - polygon.min(axis=0)
    beyond = np.maximum(above, below) > allowed
    wrong = np.where(rises, edges.min(axis=0) < -rounding, beyond)
    return np.where(falls & ~rises, edges.max(axis=0) > rounding, wrong)
