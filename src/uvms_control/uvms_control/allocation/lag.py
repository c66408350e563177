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
thrusts are linear in commands, and the limits are those of the commands. All this holds where the
slew limit does not act, for commands within slew tau of the thrust. A little beyond, x slew tau,
it acts first, and the thrust at the end is off by slew tau a (e^(x - 1) - x); commands stay where
that is next to nothing.
"""

import numpy as np

from uvms_core.signals import Array, to_seconds
from uvms_dynamics.kernels.jit import exact_kernel

SLEW_ERROR = 1e-3
"""Error of the thrust at the end of a period by the slew limit, as a share of slew tau."""


class LagCompensation:
    """Thrusts (m,) as commands make them, and what is needed to get ahead of their lag.

    Args:
        time_constants: (m,) s.
        slew: greatest rate of thrust (m,) N/s.
        share: of the lag that is compensated, 0 to 1.
    """

    def __init__(self, time_constants: Array, slew: Array, share: float) -> None:
        self._tau, self._share = time_constants, share
        self._slew_tau = slew * time_constants
        self._period: float | None = None  # s
        self.reset()

    def reset(self) -> None:
        """Thrusters at rest, and no command yet."""
        self.thrust = np.zeros_like(self._tau)
        self._command = np.zeros_like(self._tau)
        self._stamp: int | None = None
        self._since, self._decay = 0, np.ones_like(self._tau)
        self._reach = np.full_like(self._tau, np.inf)
        self._set_gain(np.zeros_like(self._tau))
        if self._period is not None:
            self.prepare(self._period)

    def _set_gain(self, gain: Array) -> None:
        self.slope = 1.0 / (1.0 + gain)
        self._kept = gain * self.slope

    def prepare(self, period: float) -> None:
        """Set how long a command is held, s, which is what is made up for."""
        self._period = period
        decay = np.exp(-period / self._tau)
        self._reach = self._slew_tau * within_slew(period / self._tau)
        self._set_gain(self._share * decay / (1.0 - decay))

    def advance(self, stamp: int) -> bool:
        """Thrusts at a stamp (ns), by the last command; True where `slope` is new by that.

        The period is that of `prepare`, or the time between the first two commands: stamps that
        jitter, or a command that is lost, do not change it.
        """
        if self._stamp is None or stamp <= self._stamp:
            return False
        since = stamp - self._stamp
        if since != self._since:
            self._since, self._decay = since, np.exp(-to_seconds(since) / self._tau)
        self.thrust = self._command + (self.thrust - self._command) * self._decay
        if self._period is not None:
            return False
        self.prepare(to_seconds(since))
        return True

    def hold(self, stamp: int, command: Array) -> None:
        """The commands (m,) N from a stamp (ns) on."""
        self._stamp, self._command = stamp, command

    def left(self, given: Array, tau: Array, lower: Array, upper: Array) -> tuple[Array, ...]:
        """What remains to be commanded, and within which bounds.

        Args:
            given: wrench per newton of thrust commanded (6, m).
            tau: wanted wrench (6,).
            lower, upper: bounds of the commands (m,) N.

        Returns:
            Wrench (6,) of the wanted thrusts that go with no command, g T / (1 + g); what it leaves
            of `tau` (6,); bounds (m,) and (m,) within which the slew limit does not act either.
        """
        wrenches, bounds = np.empty((2, 6)), np.empty((2, self.thrust.size))
        look_ahead(self.thrust, self._kept, self._reach, given, tau, lower, upper, wrenches, bounds)
        return wrenches[0], wrenches[1], bounds[0], bounds[1]


@exact_kernel
def look_ahead(thrust, kept, reach, given, tau, lower, upper, wrenches, bounds):
    """`LagCompensation.left` into `wrenches` (2, 6) and `bounds` (2, m)."""
    for row in range(6):
        total = 0.0
        for i in range(thrust.size):
            total += given[row, i] * kept[i] * thrust[i]
        wrenches[0, row], wrenches[1, row] = total, tau[row] - total
    for i in range(thrust.size):
        bounds[0, i] = max(lower[i], thrust[i] - reach[i])
        bounds[1, i] = min(upper[i], thrust[i] + reach[i])


def within_slew(periods: Array) -> Array:
    """How far commands may be from the thrusts, in slew tau, for periods of so many tau.

    The x with e^(x - 1) - x = SLEW_ERROR e^(h / tau), by x <- 1 + log(SLEW_ERROR e^(h / tau) + x).
    """
    x = np.ones_like(periods)
    for _ in range(100):  # it contracts by 0.95 or less
        x = 1.0 + np.logaddexp(np.log(SLEW_ERROR) + periods, np.log(x))
    return x


def thrust_delay(time_constant: Array, period: float, share: float) -> Array:
    """Delay, s, of the thrust behind the wanted one with this share of the lag compensated.

    The area above the response to a step, whose thrusts at the ends of the periods approach it as
    p^k with p = a (1 - c): ((1 + g) tau (1 - a) - g h) / (1 - p). It is tau without compensation
    and tau - h a / (1 - a) with all of it; the hold of the command adds h / 2 in either case.
    """
    decay = np.exp(-period / time_constant)
    gain = share * decay / (1.0 - decay)
    area = (1.0 + gain) * time_constant * (1.0 - decay) - gain * period
    return np.asarray(area / (1.0 - decay * (1.0 - share)))
