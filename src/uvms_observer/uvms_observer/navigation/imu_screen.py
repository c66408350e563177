"""Which readings of the inertial unit are believed: spikes are held back.

A reading that leaves the last good one by more than a vehicle can jerk, or than noise explains, is
not integrated: the last good reading stands in for it. Whether it was a spike or a knock, nobody
can tell from one sample, so that velocity and attitude become uncertain by what it would have
changed them. Readings that stay where they have jumped to are believed, as a force that lasts or
as a bias that has stepped: the biases become uncertain by the jump.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array

SIGMAS = 10.0
"""Of a sample's white noise: beyond any of a week's 6e7 samples."""
JERK_M_S3 = 10.0
"""Of a vehicle with thrusters: 1 m/s^2 within a lag of 0.1 s."""
ANGULAR_JERK_RAD_S2 = 3.0
"""Of the rate: 0.3 rad/s within 0.1 s."""
CONFIRM = 3
"""Readings one after the other that must agree before a jump is believed."""


class Screened(NamedTuple):
    """What to integrate, and what it leaves unknown."""

    rate: Array  # (3,) rad/s
    force: Array  # (3,) m/s^2
    turn: Array | None  # (3,) rad, std of a turn that was held back, body axes
    change: Array | None  # (3,) m/s, std of a change of velocity that was held back, body axes
    step: tuple[Array, Array] | None  # of rate and force (3,), where a jump is believed now


class ScreenMemory(NamedTuple):
    """What the screen remembers; immutable, so that a filter can go back in time."""

    rate: Array  # last good
    force: Array
    odd_rate: Array  # last one held back
    odd_force: Array
    agreeing: int = 0  # readings held back in a row that agree
    held: int = 0  # readings held back so far, for the diagnostics


class ImuScreen:
    """Decides on each reading of one unit.

    Args:
        rate_noise: std of the gyro's white noise, rad/s.
        force_noise: of the accelerometer's, m/s^2.
    """

    def __init__(self, rate_noise: float, force_noise: float) -> None:
        self._rate_jump, self._force_jump = SIGMAS * rate_noise, SIGMAS * force_noise

    def judge(
        self, memory: ScreenMemory, rate: Array, force: Array, dt: float
    ) -> tuple[Screened, ScreenMemory]:
        """A reading `dt` s after the last one."""
        if self._agree(memory.rate, memory.force, rate, force, dt):
            return Screened(rate, force, None, None, None), _after(memory, rate, force)
        agreeing = 1
        if memory.agreeing and self._agree(memory.odd_rate, memory.odd_force, rate, force, dt):
            agreeing = memory.agreeing + 1
        if agreeing >= CONFIRM:
            step = rate - memory.rate, force - memory.force
            return Screened(rate, force, None, None, step), _after(memory, rate, force)
        turn, change = np.abs(rate - memory.rate) * dt, np.abs(force - memory.force) * dt
        held = ScreenMemory(memory.rate, memory.force, rate, force, agreeing, memory.held + 1)
        return Screened(memory.rate, memory.force, turn, change, None), held

    def _agree(
        self, rate: Array, force: Array, new_rate: Array, new_force: Array, dt: float
    ) -> bool:
        rate_limit = self._rate_jump + ANGULAR_JERK_RAD_S2 * dt
        force_limit = self._force_jump + JERK_M_S3 * dt
        return bool(
            max(abs(new_rate - rate)) <= rate_limit and max(abs(new_force - force)) <= force_limit
        )


def remember(rate: Array, force: Array) -> ScreenMemory:
    """The memory after the first reading, which has to be believed."""
    return ScreenMemory(rate, force, rate, force)


def _after(memory: ScreenMemory, rate: Array, force: Array) -> ScreenMemory:
    return ScreenMemory(rate, force, rate, force, 0, memory.held)
