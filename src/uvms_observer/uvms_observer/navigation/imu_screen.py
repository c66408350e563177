"""Which readings of the inertial unit are believed: spikes are held back.

A reading that leaves the last good one by more than a vehicle can jerk, or than noise explains, is
not integrated: the last good reading stands in for it. Whether it was a spike or a knock, nobody
can tell from one sample, so that velocity and attitude become uncertain by what it would have
changed them. Readings that stay where they have jumped to are believed, as a force that lasts or
as a bias that has stepped: the velocity gets what was held back (the attitude has it by then,
by the gyrocompass), and where they stay, as a bias does, the biases become uncertain by the jump.
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
STAYS = 0.2
"""Share of a jump by which readings after it may differ from one another where it is a step."""
LONGEST = 5
"""Readings in a row that may be held back: nothing but violent motion makes so many."""


class Screened(NamedTuple):
    """What to integrate, and what it leaves unknown."""

    rate: Array  # (3,) rad/s
    force: Array  # (3,) m/s^2
    turn: Array | None  # (3,) rad, std of a turn that was held back, body axes
    change: Array | None  # (3,) m/s, std of a change of velocity that was held back, body axes
    step: tuple[Array, Array] | None  # of rate and force (3,), where a jump is believed now
    owed: Array | None  # (3,) m/s, change of velocity that was held back before that, body axes


class ScreenMemory(NamedTuple):
    """What the screen remembers; immutable, so that a filter can go back in time."""

    rate: Array  # last good
    force: Array
    odd_rate: Array  # last one held back
    odd_force: Array
    owed: Array  # (3,) m/s, change of velocity by those held back in a row, body axes
    agreeing: int = 0  # readings held back in a row that agree
    row: int = 0  # readings held back in a row
    going_on: bool = False  # whether these do not stay where they have jumped to
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
            return Screened(rate, force, None, None, None, None), _after(memory, rate, force)
        agreeing = 1
        if memory.agreeing and self._agree(memory.odd_rate, memory.odd_force, rate, force, dt):
            agreeing = memory.agreeing + 1
        step = rate - memory.rate, force - memory.force
        going_on = memory.going_on or (memory.row > 0 and _goes_on(memory, rate, force, *step))
        if agreeing >= CONFIRM or memory.row + 1 >= LONGEST:
            believed = Screened(rate, force, None, None, None if going_on else step, memory.owed)
            return believed, _after(memory, rate, force)
        turn, change = step[0] * dt, step[1] * dt
        held = ScreenMemory(
            memory.rate, memory.force, rate, force,
            memory.owed + change,
            agreeing, memory.row + 1, going_on, memory.held + 1,
        )  # fmt: skip
        unknown = np.abs(turn), np.abs(change)
        return Screened(memory.rate, memory.force, *unknown, None, None), held

    def limits(self, dt: float) -> tuple[float, float]:
        """Largest changes of rate, rad/s, and force, m/s^2, along an axis that agree after dt s."""
        return self._rate_jump + ANGULAR_JERK_RAD_S2 * dt, self._force_jump + JERK_M_S3 * dt

    def _agree(
        self, rate: Array, force: Array, new_rate: Array, new_force: Array, dt: float
    ) -> bool:
        rate_limit, force_limit = self.limits(dt)
        return bool(
            max(abs(new_rate - rate)) <= rate_limit and max(abs(new_force - force)) <= force_limit
        )


def _goes_on(memory: ScreenMemory, rate: Array, force: Array, turned: Array, pushed: Array) -> bool:
    """Whether a reading is off the one before it by a good part of what it is off the good one."""
    return bool(
        max(abs(rate - memory.odd_rate)) > STAYS * max(abs(turned))
        and max(abs(force - memory.odd_force)) > STAYS * max(abs(pushed))
    )


def remember(rate: Array, force: Array, held: int = 0) -> ScreenMemory:
    """The memory after a reading that is believed."""
    return ScreenMemory(rate, force, rate, force, np.zeros(3), held=held)


def _after(memory: ScreenMemory, rate: Array, force: Array) -> ScreenMemory:
    return remember(rate, force, memory.held)
