"""Functions of numbers that the kernels use beside + - * /."""

import math

from uvms_dynamics.kernels.jit import inner


@inner
def sine_cosine(x):
    """Sine and cosine of x."""
    return math.sin(x), math.cos(x)


@inner
def zero_like(x):
    return 0.0


@inner
def root(x):
    return math.sqrt(x)


@inner
def size(x):
    return math.fabs(x)


@inner
def bounded(x, bound):
    """The number in -bound..bound that is nearest to x."""
    return min(max(x, -bound), bound)


@inner
def positive(x):
    return max(x, 0.0)

@inner
def hyperbolic_tangent(x):
    return math.tanh(x)
