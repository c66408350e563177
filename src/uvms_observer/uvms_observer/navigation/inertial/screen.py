"""Which readings of the inertial unit are believed: spikes are held back.

A reading that leaves the last good one by more than a vehicle can jerk, or than noise explains, and
that does not go on as the readings before it changed, is not integrated: the last good reading
stands in for it. Whether it was a spike or a knock, nobody can tell from one sample, so that
velocity and attitude become uncertain by what it would have changed them. Readings that stay where
they have jumped to, or go on changing as they do, are believed, as a force that lasts or as a bias
that has stepped: the velocity gets what was held back (the attitude has it by then, by the
gyrocompass), and where they stay, as a bias does, the biases become uncertain by the jump.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array

SIGMAS = 10.0
"""Of a sample's white noise: beyond any of a week's 6e7 samples."""
CHANGES = 6.0
"""Of a sample's white noise: changes between two samples beyond that are motion."""
JERK_M_S3 = 10.0
"""Of a vehicle with thrusters: 1 m/s^2 within a lag of 0.1 s."""
ANGULAR_JERK_RAD_S2 = 3.0
"""Of the rate: 0.3 rad/s within 0.1 s."""
CONFIRM = 3
"""Readings one after the other that must agree before a jump is believed."""
STAYS = 0.2
"""Share of a jump by which readings after it may differ from one another where it is a step."""
LONGEST = 5
"""Readings in a row that may be held back: nothing but violent motion makes so many."""


class Trend(NamedTuple):
    """A reading and how fast it changes."""

    rate: Array  # (3,) rad/s
    force: Array  # (3,) m/s^2
    rate_slope: Array  # (3,) rad/s^2
    force_slope: Array  # (3,) m/s^3

    def to(self, rate: Array, force: Array, dt: float) -> "Trend":
        """The trend after the next reading, dt s later."""
        return Trend(rate, force, (rate - self.rate) / dt, (force - self.force) / dt)


class Jump(NamedTuple):
    """Readings that were held back, and are believed now."""

    before: Trend  # the reading from which on they are integrated
    rate: Array  # (3,) rad/s, by how much they are off the last good one
    force: Array  # (3,) m/s^2
    owed: Array  # (3,) m/s, change of velocity that was held back before that, body axes
    stays: bool  # whether they stay there, as a bias does


class Screened(NamedTuple):
    """What to integrate, and what it leaves unknown."""

    rate: Array  # (3,) rad/s
    force: Array  # (3,) m/s^2
    turn: Array | None = None  # (3,) rad, std of a turn that was held back, body axes
    change: Array | None = None  # (3,) m/s, std of a change of velocity that was held back
    jump: Jump | None = None  # where one is believed now


def still(rate: Array, force: Array) -> Trend:
    """Of a reading before which there was none."""
    return Trend(rate, force, np.zeros(3), np.zeros(3))


class ScreenMemory(NamedTuple):
    """What the screen remembers; immutable, so that a filter can go back in time."""

    good: Trend  # last reading that was believed
    odd: Trend  # last one held back
    owed: Array  # (3,) m/s, change of velocity by those held back in a row, body axes
    gone: float = 0.0  # s, since the last good one
    agreeing: int = 0  # readings held back in a row that agree
    row: int = 0  # readings held back in a row
    going_on: bool = False  # whether these do not stay where they have jumped to
    held: int = 0  # readings held back so far, for the diagnostics


class ImuScreen:
    """Decides on each reading of one unit.

    Args:
        rate_noise: std of the gyro's white noise, rad/s.
        force_noise: of the accelerometer's, m/s^2.
        period: between two readings, s.
    """

    def __init__(self, rate_noise: float, force_noise: float, period: float) -> None:
        self._rate_jump, self._force_jump = SIGMAS * rate_noise, SIGMAS * force_noise
        self.allowance = self._rate_jump, ANGULAR_JERK_RAD_S2, self._force_jump, JERK_M_S3
        """Change of the rate that is believed at once, and by the second; the same of the force."""
        self._sure = CHANGES * rate_noise / period, CHANGES * force_noise / period
        self._period = period

    def judge(
        self, memory: ScreenMemory, rate: Array, force: Array, dt: float
    ) -> tuple[Screened, ScreenMemory]:
        """A reading `dt` s after the last one."""
        good, gone = memory.good, memory.gone + dt
        if self._agree(good, rate, force, dt, gone):
            after = remember(good.to(rate, force, gone), memory.held)
            return Screened(rate, force), after
        odd = (memory.odd if memory.row else good).to(rate, force, dt)
        agreeing = 1
        if memory.agreeing and self._agree(memory.odd, rate, force, dt, dt):
            agreeing = memory.agreeing + 1
        step = rate - good.rate, force - good.force
        going_on = memory.going_on or (memory.row > 0 and _goes_on(memory.odd, rate, force, *step))
        if agreeing >= CONFIRM or memory.row + 1 >= LONGEST:
            jump = Jump(memory.odd, *step, memory.owed, not going_on)
            return Screened(rate, force, jump=jump), remember(odd, memory.held)
        turn, change = step[0] * dt, step[1] * dt
        held = ScreenMemory(
            good, odd, memory.owed + change,
            gone, agreeing, memory.row + 1, going_on, memory.held + 1,
        )  # fmt: skip
        return Screened(good.rate, good.force, np.abs(turn), np.abs(change)), held

    def ahead(self, good: Trend, dt: float) -> tuple[Array, Array]:
        """Rate and force dt s after the last good reading; only changes beyond noise go on."""
        (rate_sure, force_sure), dt = self._sure, min(dt, self._period)
        rate_slope = np.where(np.abs(good.rate_slope) > rate_sure, good.rate_slope, 0.0)
        force_slope = np.where(np.abs(good.force_slope) > force_sure, good.force_slope, 0.0)
        return good.rate + rate_slope * dt, good.force + force_slope * dt

    def limits(self, dt: float) -> tuple[float, float]:
        """Largest changes of rate, rad/s, and force, m/s^2, along an axis that agree after dt s."""
        rate, angular_jerk, force, jerk = self.allowance
        return rate + angular_jerk * dt, force + jerk * dt

    def knows_rate(self, memory: ScreenMemory) -> bool:
        """Whether the last reading's rate is believed, whatever its force."""
        turned = np.abs(memory.odd.rate - memory.good.rate)
        return memory.row == 0 or bool((turned <= self._rate_jump).all())

    def _agree(self, before: Trend, rate: Array, force: Array, dt: float, gone: float) -> bool:
        """Whether a reading stays where one was `gone` s before, or goes on as that one did.

        By no more than what may happen in dt, s: what stays away is a step, however long ago.
        """
        rate_limit, force_limit = self.limits(dt)
        turned, pushed = rate - before.rate, force - before.force
        return bool(
            (_least(turned, turned - before.rate_slope * gone) <= rate_limit).all()
            and (_least(pushed, pushed - before.force_slope * gone) <= force_limit).all()
        )


def _least(change: Array, other: Array) -> Array:
    return np.minimum(np.abs(change), np.abs(other))


def _goes_on(before: Trend, rate: Array, force: Array, turned: Array, pushed: Array) -> bool:
    """Whether a reading is off the one before it by a good part of what it is off the good one."""
    return bool(
        max(abs(rate - before.rate)) > STAYS * max(abs(turned))
        and max(abs(force - before.force)) > STAYS * max(abs(pushed))
    )


def remember(good: Trend, held: int = 0) -> ScreenMemory:
    """The memory after a reading that is believed."""
    return ScreenMemory(good, good, np.zeros(3), held=held)
