"""The noise that the filter assumes of a sample: what the vehicle file says, and its message.

The vehicle file says how large the errors are: white noise, which the filter takes as such, and
biases, which are states of the filter. A message that states a greater variance than both together
has more noise by the difference, which is added to the white one. It never has less: a driver
knows its own noise, but not what the vehicle does to the instrument. Where a message states
nothing (zeros, or -1 first) the vehicle file counts alone.

A constant error that is no state of the filter does not average out over samples. It is taken as
noise that lasts `LASTING_S`: as so much white noise that as many samples leave it as it is.
"""

from collections.abc import Sequence
from math import ceil, log, pi, sqrt

import numpy as np

from uvms_core.signals import Array

LASTING_S = 100.0
"""How long an error without a state is taken to last, s: some of the vehicle's manoeuvres, in which
it changes its sign."""

ROUNDED = 0.25
"""Step to which drivers round at least, in std of the noise, where a vehicle file says nothing."""
BY_CHANCE = 1e-7
"""Share of samples that may end a row of equal ones by chance: one in weeks."""


def with_stated(white: Array, stated: Array, known: Sequence[float]) -> Array:
    """White noise (k,) of a sample, a variance.

    Args:
        white: (k,) variance by the vehicle file, not below the filter's floor.
        stated: (k, k) covariance that the message states.
        known: (k,) variance of all errors that the vehicle file knows of.
    """
    for i, limit in enumerate(known):
        if stated[i, i] > limit:
            return white + np.maximum(stated.diagonal() - known, 0.0)
    return white


def as_white(std: float, rate_hz: float) -> float:
    """Variance of the white noise that stands for a constant error, by its std."""
    return std**2 * max(1.0, rate_hz * LASTING_S)


def most_alike(std: float, step: float, size: int) -> int | None:
    """How many samples in a row may be the same to the last bit; None: any number.

    Two values with white noise that are rounded to a step are the same at rest with a probability
    of about step / (2 sqrt(pi) std), where the step is small.

    Args:
        std: of the white noise of each value.
        step: to which they are rounded; 0 where it is not known.
        size: number of values.
    """
    if std == 0.0:
        return None
    same = (max(step, ROUNDED * std) / (2.0 * sqrt(pi) * std)) ** size
    return None if same > 0.5 else 1 + ceil(log(BY_CHANCE) / log(same))
