"""Size of the noise of the unexplained wrench, from the wrench itself."""

import numpy as np

from uvms_core.signals import Array

FORGET_S = 10.0
"""The noise of sensors changes slowly, if at all; a gust is over sooner."""
CLIP = 4.0
"""Squared differences count up to so many variances: a jump of the disturbance is not noise."""
FLOOR = 1e-9
"""N or N m; keeps the weights finite where a test feeds perfect signals."""


class NoiseLevel:
    """Standard deviation of each channel (6,), by the second differences of neighbouring ticks.

    A sixth of their mean square is the variance of white noise, and of a wave or a ramp next to
    nothing; for the noise of a velocity that was divided by dt, which alternates, it is too large
    by two thirds, to the safe side.
    """

    def __init__(self) -> None:
        self._variance = np.zeros(6)
        self._before: list[Array] = []
        self._count = 0

    def step(self, dt: float, wrench: Array, sigma: Array) -> Array:
        """Weights 1 / sigma^2 (6,) after another wrench (6,).

        `sigma` (6,) is what the observer states; the larger of both counts.
        """
        if len(self._before) == 2:
            first, second = self._before
            self._take(dt, (wrench - 2.0 * second + first) ** 2 / 6.0)
        self._before = [*self._before[-1:], wrench]
        return 1.0 / np.maximum(np.maximum(self._variance, sigma * sigma), FLOOR**2)

    def _take(self, dt: float, square: Array) -> None:
        self._count += 1
        share = max(dt / FORGET_S, 1.0 / self._count)
        if share < 1.0 and self._count * dt > 1.0:
            square = np.minimum(square, CLIP * self._variance)
        self._variance = self._variance + share * (square - self._variance)
