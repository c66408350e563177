"""The largest bandwidth of an axis that keeps its margins.

    P = w^2,    D = 2 zeta sqrt(P + c / m),    K as the observer has it

The hull's righting stiffness c acts beside P, and the damping is that of both together; the hull's
own drag comes on top. Of several damping ratios zeta the one that reaches furthest is taken: the
lag of the thrusters takes damping from a hull that floats freely, so that more must be laid out,
while beside a stiff hull much damping is what the lag does not bear. Where even w = 0 has more
damping than the loop bears, the hull keeps what it has and D = 2 zeta w is what the loop adds.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import ceil, pi, sqrt

import numpy as np

from uvms_control.design.axis import Axis, AxisGains, loop_matrices
from uvms_control.design.margins import (
    Margins,
    bears_delay,
    continuous_poles,
    is_stable,
    least_damping,
    loop_margins,
    noise_rms,
)

LOWEST = 1e-3
"""Of the Nyquist frequency: the least bandwidth that counts."""
STEP = 1.6
"""Ratio of the bandwidths that are tried to find one that keeps the limits."""
RESOLUTION = 1.002
"""Of the bandwidth that is found."""


@dataclass(frozen=True)
class Limits:
    """What a loop must keep."""

    delay_periods: float = 2.0  # further delay in control periods: late messages, slower thrusters
    gain: float = 2.0  # factor on the thrusters' gain: 6 dB, the usual one
    damping: float = 0.5  # least damping ratio of the closed loop; 16 % of overshoot
    noise_share: float = 0.05  # of the authority, rms, spent on sensor noise
    phase: float = np.radians(30.0)  # of the thrusters' response
    ratios: tuple[float, ...] = (0.8, 1.0, 0.6)  # zeta: what the gains may be laid out for
    highest: float = np.inf  # bandwidth that is asked for at most, rad/s


@dataclass(frozen=True)
class AxisDesign:
    """Gains of one axis, and why they are not larger."""

    axis: Axis
    bandwidth: float  # w, rad/s: the root of the stiffness; 0 where no gains keep the limits
    ratio: float  # zeta
    gains: AxisGains
    limited_by: str  # of `REASONS`

    @cached_property
    def margins(self) -> Margins:
        """What this loop has in hand."""
        return loop_margins(self.axis, self.gains)


REASONS = (
    "delay margin",
    "gain margin",
    "phase margin",
    "damping",
    "noise",
    "asked for",
    "nothing within reach",
)


@lru_cache(maxsize=512)
def largest_bandwidth(axis: Axis, limits: Limits = Limits()) -> AxisDesign:
    """The gains of the largest bandwidth that keeps the limits; all gains 0 where none does."""
    for hull in (True, False):
        best: AxisDesign | None = None
        for ratio in limits.ratios:
            best = _larger(axis, limits, _Layout(ratio, hull), best)
        if best is not None:
            return best
    return AxisDesign(axis, 0.0, limits.ratios[0], AxisGains(0.0, 0.0), REASONS[-1])


@dataclass(frozen=True)
class _Layout:
    """One family of gains."""

    ratio: float
    hull: bool  # damp the hull's own swinging as well

    def gains(self, axis: Axis, bandwidth: float) -> AxisGains:
        stiffness = bandwidth**2
        whole = stiffness + max(axis.hull_stiffness, 0.0) if self.hull else stiffness
        return AxisGains(stiffness, 2.0 * self.ratio * sqrt(whole), axis.observer)

    def damping(self, axis: Axis, gains: AxisGains) -> float:
        """Share of the damping laid out: below 1 where the hull keeps its own."""
        whole = gains.stiffness + max(axis.hull_stiffness, 0.0)
        given = gains.damping + axis.drag / axis.inertia
        return min(given / (2.0 * self.ratio * sqrt(whole)), 1.0)


def broken(axis: Axis, gains: AxisGains, limits: Limits, damping: float = 1.0) -> str | None:
    """The first limit that the loop does not keep, or None.

    `damping`: share of the limit on the damping ratio that is asked for.
    """
    loop = loop_matrices(axis, gains)
    closed = loop.closed()
    if not is_stable(closed) or not _bears_delays(axis, gains, limits):
        return "delay margin"
    if not is_stable(loop.closed(limits.gain)):
        return "gain margin"
    if not is_stable(loop.closed(np.exp(-1j * limits.phase))):
        return "phase margin"
    poles = continuous_poles(np.linalg.eigvals(closed), axis.period)
    if least_damping(poles) < limits.damping * damping:
        return "damping"
    if noise_rms(loop) > limits.noise_share * axis.authority:
        return "noise"
    return None


def _bears_delays(axis: Axis, gains: AxisGains, limits: Limits) -> bool:
    """Up to the whole delay: a loop may be stable again beyond one that it does not bear."""
    longest = limits.delay_periods * axis.period
    steps = max(ceil(limits.delay_periods), 1)
    return all(bears_delay(axis, gains, longest * k / steps) for k in range(steps, 0, -1))


def _larger(
    axis: Axis, limits: Limits, layout: _Layout, best: AxisDesign | None
) -> AxisDesign | None:
    """The largest bandwidth of a family, or `best` where that reaches further."""
    nyquist = pi / axis.period
    high = min(nyquist, limits.highest)

    def fault(bandwidth: float) -> str | None:
        gains = layout.gains(axis, bandwidth)
        return broken(axis, gains, limits, layout.damping(axis, gains))

    # A hull that turns over bears no small bandwidth: the least one has to be looked for.
    lowest = LOWEST * nyquist if best is None else best.bandwidth
    tried = np.geomspace(lowest, high, 2 + int(np.log(max(high / lowest, 1.0)) / np.log(STEP)))
    low = next((float(each) for each in tried if fault(float(each)) is None), None)
    if low is None:
        return best
    reason = fault(high)
    if reason is None:
        return AxisDesign(axis, high, layout.ratio, layout.gains(axis, high), "asked for")
    while high > low * RESOLUTION:
        middle = sqrt(low * high)
        now = fault(middle)
        if now is None:
            low = middle
        else:
            high, reason = middle, now
    return AxisDesign(axis, low, layout.ratio, layout.gains(axis, low), reason)
