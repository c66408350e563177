"""Poles, margins, bandwidth and noise of an axis under sampled control.

All margins are found on the closed loop itself, by where its spectral radius becomes one as the
thrusters' gain is multiplied by g, by exp(-j phi), or as they get their commands later: the loop is
cut where the command goes to the thrusters, so that the observer does not know of the change.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import sqrt
from typing import Any

import numpy as np

from uvms_control.design.axis import Axis, AxisGains, LoopMatrices, loop_matrices
from uvms_core.signals import Array

BISECTIONS = 22
"""Halvings of a bracket: to 2^-22 of it."""
LONGEST_DELAY = 60
"""Periods; a loop that bears more is said to bear any."""
GREATEST_GAIN = 1e3
FREQUENCIES = 400
DOUBLINGS = 40
"""Of the sum of a covariance: 2^40 ticks."""


@dataclass(frozen=True)
class Margins:
    """What a loop has in hand; times in s, angles in rad, frequencies in rad/s."""

    poles: Array  # (n,) complex, 1/s, of those that are slower than one tick
    stable: bool
    damping_ratio: float  # least of the poles
    delay_margin: float  # further delay that the loop bears; inf: any
    gain_margin: float  # factor on the thrusters' gain that the loop bears; inf: any
    gain_reduction: float  # least factor that it needs; 0: none
    phase_margin: float  # up to pi
    bandwidth: float  # highest frequency at which the loop's gain is one; 0: always below
    noise_rms: float  # thrust that sensor noise causes, N or N m
    noise_share: float  # of the authority


def loop_margins(axis: Axis, gains: AxisGains) -> Margins:
    """Margins of the loop of an axis with these gains; an unstable loop has none."""
    loop = loop_matrices(axis, gains)
    poles = continuous_poles(np.linalg.eigvals(loop.closed()), axis.period)
    stable = is_stable(loop.closed())
    rms = noise_rms(loop) if stable else np.inf
    return Margins(
        poles=poles,
        stable=stable,
        damping_ratio=least_damping(poles),
        delay_margin=delay_margin(axis, gains) if stable else 0.0,
        gain_margin=_gain_margin(loop) if stable else 1.0,
        gain_reduction=_gain_reduction(loop) if stable else 1.0,
        phase_margin=_phase_margin(loop) if stable else 0.0,
        bandwidth=_bandwidth(loop, axis.period),
        noise_rms=rms,
        noise_share=rms / axis.authority if rms else 0.0,
    )


def is_stable(matrix: Array) -> bool:
    """Whether a discrete system's spectral radius is below one; rounding of 1e-9 counts as one."""
    return bool(np.abs(np.linalg.eigvals(matrix)).max() < 1.0 - 1e-9)


def continuous_poles(eigenvalues: Any, period: float) -> Array:
    """Poles ln(z) / h of the eigenvalues that do not vanish within a tick, slowest first."""
    lasting = eigenvalues[np.abs(eigenvalues) > 1e-3].astype(complex)
    poles = np.log(lasting) / period
    return poles[np.argsort(-poles.real)]


def least_damping(poles: Array) -> float:
    """The least -cos(angle) of the poles; 1 where none swings."""
    sizes = np.abs(poles)
    return float(np.min(-poles.real / np.where(sizes > 0.0, sizes, 1.0), initial=1.0))


def bears_delay(axis: Axis, gains: AxisGains, extra: float) -> bool:
    """Whether the loop is stable with so much more delay, s."""
    return is_stable(loop_matrices(axis, gains, extra).closed())


def bears_gain(loop: LoopMatrices, gain: float) -> bool:
    """Whether the loop is stable with the thrusters' gain multiplied so."""
    return is_stable(loop.closed(gain))


def delay_margin(axis: Axis, gains: AxisGains) -> float:
    """Least further delay, s, at which the loop becomes unstable; inf beyond `LONGEST_DELAY`."""
    low, step = 0.0, 0.25 * axis.period
    longest = LONGEST_DELAY * axis.period
    while low < longest:
        high = low + step
        if not bears_delay(axis, gains, high):
            return _boundary(lambda delay: bears_delay(axis, gains, delay), low, high)
        low, step = high, 1.2 * step
    return np.inf


def noise_rms(loop: LoopMatrices) -> float:
    """Root mean square of the wanted thrust that the noise causes: x, v white from tick to tick."""
    covariance = _stationary(loop.closed(), loop.N + np.outer(loop.B, loop.E))
    variance = float(loop.U @ covariance @ loop.U + loop.F @ loop.F)
    return sqrt(max(variance, 0.0))


def _stationary(system: Array, noise: Array) -> Array:
    """Covariance sum A^k N N' A'^k, by doubling the number of terms."""
    power, total = system, noise @ noise.T
    for _ in range(DOUBLINGS):
        more = power @ total @ power.T
        total = total + more
        if np.abs(more).max() <= 1e-12 * np.abs(total).max():
            break
        power = power @ power
    return total


def _gain_margin(loop: LoopMatrices) -> float:
    low = 1.0
    while low < GREATEST_GAIN:
        high = 1.15 * low
        if not bears_gain(loop, high):
            return _boundary(lambda gain: bears_gain(loop, gain), low, high)
        low = high
    return np.inf


def _gain_reduction(loop: LoopMatrices) -> float:
    high = 1.0
    while high > 1.0 / GREATEST_GAIN:
        low = high / 1.15
        if not bears_gain(loop, low):
            return _boundary(lambda gain: bears_gain(loop, gain), high, low)
        high = low
    return 0.0


def _phase_margin(loop: LoopMatrices) -> float:
    def bears(phase: float) -> bool:
        return is_stable(loop.closed(np.exp(-1j * phase)))

    steps = np.linspace(0.0, np.pi, 37)
    for low, high in pairwise(steps):
        if not bears(float(high)):
            return _boundary(bears, float(low), float(high))
    return np.pi


def _boundary(holds: Callable[[float], bool], good: float, bad: float) -> float:
    """The last value that holds between one that does and one that does not."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (good + bad)
        if holds(middle):
            good = middle
        else:
            bad = middle
    return good


def _bandwidth(loop: LoopMatrices, period: float) -> float:
    """Highest frequency at which the open loop's gain falls through one, log-log between points."""
    frequencies = np.geomspace(1e-4, 1.0, FREQUENCIES) * np.pi / period
    z = np.exp(1j * frequencies * period)
    systems = z[:, None, None] * np.eye(len(loop.A)) - loop.A
    response = np.linalg.solve(systems, np.broadcast_to(loop.B[:, None], (len(z), len(loop.A), 1)))
    size = np.log(np.maximum(np.abs(response[:, :, 0] @ loop.C), 1e-300))
    falls = np.nonzero((size[:-1] >= 0.0) & (size[1:] < 0.0))[0]
    if not len(falls):
        return 0.0 if size[-1] < 0.0 else float(frequencies[-1])
    k = falls[-1]
    share = size[k] / (size[k] - size[k + 1])
    return float(frequencies[k] * (frequencies[k + 1] / frequencies[k]) ** share)
