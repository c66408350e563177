"""Linear water waves: wave number and greatest height.

Airy (1845), as in Newman, Marine Hydrodynamics (1977), ch. 6, and Faltinsen, Sea Loads on Ships
and Offshore Structures (1990), ch. 2.
"""

import math

STANDARD_GRAVITY = 9.80665
"""m/s^2: what a wave's length is reckoned with where no vehicle is known."""

_BREAKING = 0.142
"""Miche (1944): H / L of the steepest wave in deep water, times tanh(k h) in less."""


def wave_number(period: float, depth: float, gravity: float = STANDARD_GRAVITY) -> float:
    """k, 1/m, of a wave of this period, s, in water of this depth, m: omega^2 = g k tanh(k h).

    By Newton's steps in x = k h: x tanh x has no turning point, and the larger of its values for
    deep and for shallow water is never above the root and at most a fifth below it.
    """
    target = (2.0 * math.pi / period) ** 2 * depth / gravity
    x = max(target, math.sqrt(target))  # deep and shallow water
    for _ in range(100):
        t = math.tanh(x)
        step = (x * t - target) / (t + x * (1.0 - t * t))
        x -= step
        if abs(step) <= 1e-15 * x:
            break
    return x / depth


def wave_length(period: float, depth: float) -> float:
    """Length, m, of a wave of this period, s, in water of this depth, m."""
    return 2.0 * math.pi / wave_number(period, depth)


def highest_wave(period: float, depth: float) -> float:
    """Height, m, at which a wave breaks: 0.142 L tanh(k h)."""
    k = wave_number(period, depth)
    return _BREAKING * 2.0 * math.pi / k * math.tanh(k * depth)
