"""A penalty for g <= 0 that is smooth, defined everywhere, and exact in the limit mu -> 0.

The least of rho t - mu log s - mu log t over s - t = -g: the logarithmic barrier of a constraint
that may be broken at the price rho (Nocedal and Wright, Numerical Optimization, 2006, ch. 17 and
19, with the slacks s and t eliminated). Its slope lies between 0 and rho and estimates the
multiplier, so that a problem without a solution ends where limits are broken least.
"""

import numpy as np

from uvms_dynamics.kernels.jit import inner


@inner
def multiplier(g, mu, rho):
    """Slope of the penalty at g: the positive root of mu / z - mu / (rho - z) = -g."""
    a = abs(g) * rho
    small = 2.0 * mu * rho / (2.0 * mu + a + np.sqrt(a * a + 4.0 * mu * mu))
    return small if g < 0.0 else rho - small


@inner
def penalty(g, mu, rho):
    """The penalty itself (less what it is far from the limit), and its slope and curvature."""
    z = multiplier(g, mu, rho)
    y = multiplier(-g, mu, rho)
    s, t = mu / z, mu / y
    value = rho * t - mu * (1.0 + np.log(s) + np.log(t * rho / mu))
    return value, z, 1.0 / (s / z + t / y)
