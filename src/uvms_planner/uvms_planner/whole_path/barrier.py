"""A penalty for g <= 0 that is smooth, defined everywhere, and exact in the limit mu -> 0.

The least of rho t - mu log s - mu log t over s - t = -g: the logarithmic barrier of a constraint
that may be broken at the price rho (Nocedal and Wright, Numerical Optimization, 2006, ch. 17 and
19, with the slacks s and t eliminated). Its slope lies between 0 and rho and estimates the
multiplier, so that a problem without a solution ends where limits are broken least.
"""

import numpy as np

from uvms_dynamics.kernels.jit import inner

TRUST = 100.0  # how far a multiplier may be from the barrier's own


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


@inner
def linearised(g, mu, rho, memory, i, j, k):
    """Slope and curvature of the penalty for a primal-dual Newton step.

    memory[i, j] remembers in its columns k and k + 1 what a step changes the multiplier z into,
    z = a + w g; a < 0 where there has been none. The system is that of z s = mu and
    (rho - z) t = mu with the slacks at their best, so that lowering mu does not shorten the steps.
    """
    ideal, rest = multiplier(g, mu, rho), multiplier(-g, mu, rho)
    if g > 0.0:
        # The slope falls to almost nothing at g = 0, which the curvature here does not show.
        z, y, w = ideal, rest, max(1.0 / (mu / ideal**2 + mu / rest**2), ideal / g)
    else:
        z = memory[i, j, k] + memory[i, j, k + 1] * g if memory[i, j, k] >= 0.0 else ideal
        z = min(max(z, ideal / TRUST), ideal * TRUST)
        y = min(max(rho - z, rest / TRUST), rest * TRUST)
        z = rho - y
        w = 1.0 / (mu / (ideal * z) + mu / (rest * y))
    a = z + w * (mu / z - mu / y) if g <= 0.0 else z - w * g
    memory[i, j, k], memory[i, j, k + 1] = max(a, 0.0), w
    return a + w * g, w
