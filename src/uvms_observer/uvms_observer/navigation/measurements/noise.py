"""The noise that the filter assumes of a sample: what the vehicle file says, and its message.

The vehicle file says how large the errors are: white noise, which the filter takes as such, and
biases, which are states of the filter. A message that states a greater variance than both together
has more noise by the difference, which is added to the white one. It never has less: a driver
knows its own noise, but not what the vehicle does to the instrument. Where a message states
nothing (zeros, or -1 first) the vehicle file counts alone.

The inertial unit's rates and forces are no measurements, but carry the state. What their messages
state beyond the vehicle file is in the state (`NavigationState.excess`) until the next sample: it
makes the covariance grow, and it is part of what reads rate or force.

A constant error that is no state of the filter does not average out over samples. It is taken as
noise that lasts `LASTING_S`: as so much white noise that as many samples leave it as it is.
"""

from math import ceil, log, pi, sqrt

from uvms_core.signals import Array

ByAxis = tuple[float, float, float]
"""A value for each of three axes."""
NOTHING: ByAxis = 0.0, 0.0, 0.0
"""What `beyond` finds in the usual case."""

MOST = 1e6
"""Largest variance that is taken from a message, in SI units: with it a sample says nothing, and
beside it double precision still holds the other states."""
LASTING_S = 100.0
"""How long an error without a state is taken to last, s: some of the vehicle's manoeuvres, in which
it changes its sign."""

ROUNDED = 0.25
"""Step to which drivers round at least, in std of the noise, where a vehicle file says nothing."""
BY_CHANCE = 1e-7
"""Share of samples that may end a row of equal ones by chance: one in weeks."""


def with_stated(white: Array, stated: Array, known: ByAxis) -> Array:
    """White noise (3,) of a sample, a variance.

    Args:
        white: (3,) variance by the vehicle file, not below the filter's floor.
        stated: (3, 3) covariance that the message states.
        known: variance of all errors that the vehicle file knows of.
    """
    excess = beyond(stated, known)
    return white if excess is NOTHING else white + excess


def beyond(stated: Array, known: ByAxis) -> ByAxis:
    """Variance that a message's covariance (3, 3) has beyond what the vehicle file knows of."""
    x, y, z = stated.item(0), stated.item(4), stated.item(8)
    if x <= known[0] and y <= known[1] and z <= known[2]:
        return NOTHING
    return bounded(x - known[0]), bounded(y - known[1]), bounded(z - known[2])


def bounded(excess: float) -> float:
    """A variance that a message states beyond what is known: from zero to `MOST`."""
    return min(max(0.0, excess), MOST)


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
