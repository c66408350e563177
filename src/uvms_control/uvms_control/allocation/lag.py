"""Thrusters' lag, taken into account: commands beyond the wanted thrust, so that it comes sooner.

A thruster follows its command by T' = (T_c - T) / tau, so that over a period h with a constant
command T_end = a T + (1 - a) T_c with a = exp(-h / tau) (zero-order hold, Astrom and Wittenmark,
Computer-Controlled Systems, section 2.3). The command (T_w - a T) / (1 - a) would have the wanted
thrust T_w there at the end of the period, when the next command comes. To ask instead that the mean
over the period is the wanted thrust looks better and is not: the thrust itself then swings about
it, by a factor of -0.88 from period to period at h / tau = 0.4, and commands swing with it.

A `share` c of that compensation is

    T_c = T_w + g (T_w - T),   g = c a / (1 - a),   or   T_w = (T_c + g T) / (1 + g),

which leaves the thrust a pole at a (1 - c). The second form is what the allocator needs: wanted
thrusts are linear in commands, and the limits are those of the commands. Commands stay within
slew tau of the thrust, where the slew limit does not act and all this holds.
"""

import numpy as np

from uvms_core.signals import Array, to_seconds


class LagCompensation:
    """Thrusts (m,) as commands make them, and what is needed to get ahead of their lag.

    Args:
        time_constants: (m,) s.
        slew: greatest rate of thrust (m,) N/s.
        share: of the lag that is compensated, 0 to 1.
    """

    def __init__(self, time_constants: Array, slew: Array, share: float) -> None:
        self._tau, self._share = time_constants, share
        self._reach = slew * time_constants
        self.reset()

    def reset(self) -> None:
        """Thrusters at rest, and no command yet."""
        self.thrust = np.zeros_like(self._tau)
        self._command = np.zeros_like(self._tau)
        self._stamp: int | None = None
        self._period: int | None = None
        self.gain = np.zeros_like(self._tau)
        self.slope = np.ones_like(self._tau)

    def advance(self, stamp: int) -> bool:
        """Thrusts at a stamp (ns), by the last command; True where the gains are new by that.

        The period is the shortest time between two commands: one that was lost does not change it.
        """
        if self._stamp is None or stamp <= self._stamp:
            return False
        since = stamp - self._stamp
        decay = np.exp(-to_seconds(since) / self._tau)
        self.thrust = self._command + (self.thrust - self._command) * decay
        if self._period is not None and since >= self._period:
            return False
        self._period = since
        self.gain = self._share * decay / (1.0 - decay)
        self.slope = 1.0 / (1.0 + self.gain)
        return True

    def hold(self, stamp: int, command: Array) -> None:
        """The commands (m,) N from a stamp (ns) on."""
        self._stamp, self._command = stamp, command

    def bounds(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Bounds (m,) of commands, N, within which the slew limit does not act."""
        low, high = self.thrust - self._reach, self.thrust + self._reach
        return np.clip(low, lower, upper), np.clip(high, lower, upper)

    @property
    def offset(self) -> Array:
        """Wanted thrusts (m,) N that go with no command: g T / (1 + g)."""
        return self.gain * self.slope * self.thrust

    def wanted(self, command: Array) -> Array:
        """Wanted thrusts (m,) N that commands (m,) N stand for."""
        return self.slope * command + self.offset
