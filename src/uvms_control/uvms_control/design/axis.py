"""One axis of the vehicle under sampled control, as a linear system in discrete time.

The hull  m x'' = f - c x - d x' + w  is pushed by thrusters with first-order lag,  T f' = p - f,
which get the command p of a tick `delay` seconds later and hold it for a period h (Franklin,
Powell and Workman, Digital Control of Dynamic Systems, 3rd ed., sec. 4.3: exact for every delay).
At a tick the controller has the estimates x and v with the noise of the navigation, and gives

    u = -m (P x + D v) - w_hat,        p = u + s a / (1 - a) (u - f_hat),    a = exp(-h / T),

where s is the share of the lag that the allocator makes up for: a whole one lets the thrust arrive
within the tick. The righting moment c x and the drag d v stay on the hull's side, as the law leaves
them (restoring at the reference attitude, damping at the reference velocity). The external
observer is the momentum residual of bandwidth K,

    w_hat += (1 - exp(-K h)) (m dv / h + c x + d v - f_mean - w_hat),

which knows the hull and the lag, but not the delay nor what the thrusters lack.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from uvms_control.errors import ControlSetupError
from uvms_core.signals import Array

TAYLOR_TERMS = 14
"""Of the matrix exponential for a norm below 1/2: 2^-15 / 15! is below the rounding."""


@dataclass(frozen=True)
class Axis:
    """What the vehicle brings: forces in N or N m, positions in m or rad."""

    inertia: float  # m: with added mass and the arm, kg or kg m^2
    righting: float = 0.0  # c, N/m or N m/rad; negative: the hull turns over
    drag: float = 0.0  # d, linear, N per m/s or N m per rad/s
    period: float = 0.05  # h: of the control loop, s
    lag: float = 0.0  # T: time constant of the thrusters, s
    lag_compensated: float = 0.0  # s, 0 to 1
    delay: float = 0.0  # from the sensors' stamp to the thrusters' command, s
    authority: float = np.inf  # greatest force or moment, N or N m
    position_noise: float = 0.0  # std of the estimate, from tick to tick, m or rad
    rate_noise: float = 0.0  # m/s or rad/s
    observer: float = 0.0  # K, rad/s: bandwidth of the external wrench that is fed forward

    def __post_init__(self) -> None:
        for name in ("inertia", "period", "authority"):
            _require(name, getattr(self, name), getattr(self, name) > 0.0, "above 0")
        for name in ("drag", "lag", "delay", "position_noise", "rate_noise", "observer"):
            value = getattr(self, name)
            _require(name, value, 0.0 <= value < np.inf, "0 or more")
        share = self.lag_compensated
        _require("lag_compensated", share, 0.0 <= share <= 1.0, "from 0 to 1")
        _require("righting", self.righting, bool(np.isfinite(self.righting)), "finite")

    @property
    def hull_stiffness(self) -> float:
        """Square of the hull's own natural frequency, c / m, 1/s^2."""
        return self.righting / self.inertia


@dataclass(frozen=True)
class AxisGains:
    """Feedback of one axis near the reference; 0 for none."""

    stiffness: float  # P, 1/s^2: acceleration per error
    damping: float  # D, 1/s: acceleration per rate of the error
    observer: float = 0.0  # K, rad/s: bandwidth of the external wrench that is fed forward

    def __post_init__(self) -> None:
        for name in ("stiffness", "damping", "observer"):
            value = getattr(self, name)
            _require(name, value, 0.0 <= value < np.inf, "0 or more")


@dataclass(frozen=True)
class LoopMatrices:
    """The loop, cut where the command goes to the thrusters: z+ = A z + B p' + N n, p = C z + E n.

    Closed with the gain g, p' = g p: A + g B C. The noise n (2,) is that of position and rate, each
    with unit variance. The thrust wanted is u = U z + F n.
    """

    A: Array
    B: Array
    C: Array
    N: Array
    E: Array
    U: Array
    F: Array

    def closed(self, gain: complex = 1.0) -> Array:
        """System matrix with the thrusters' gain multiplied by `gain`."""
        return self.A + gain * np.outer(self.B, self.C)


def loop_matrices(axis: Axis, gains: AxisGains, extra_delay: float = 0.0) -> LoopMatrices:
    """The discrete loop; states x, v, f, f_hat, w_hat, the residual's memory, commands on the way.

    `extra_delay` s comes on top of the axis' own.
    """
    m, c, d, h = axis.inertia, axis.righting, axis.drag, axis.period
    plant, before, now, ticks = _plant(axis, axis.delay + extra_delay)
    size = 6 + ticks + 1
    # Rows over the states, then the two noises.
    x, v, f, f_hat, w, memory, *queue = np.eye(size, size + 2)
    x_hat = x + axis.position_noise * np.eye(1, size + 2, size)[0]
    v_hat = v + axis.rate_noise * np.eye(1, size + 2, size + 1)[0]

    missing = (m / h + 0.5 * d) * v_hat + 0.5 * c * x_hat + memory
    gain = -np.expm1(-gains.observer * h)
    w_hat = w + gain * (missing - w) if gain > 0.0 else 0.0 * w
    u = -m * (gains.stiffness * x_hat + gains.damping * v_hat) - w_hat
    a = np.exp(-h / axis.lag) if axis.lag > 0.0 else 0.0
    p = u + axis.lag_compensated * a / (1.0 - a) * (u - f_hat)
    mean = p + (f_hat - p) * (1.0 - a) * axis.lag / h
    remembered = (0.5 * d - m / h) * v_hat + 0.5 * c * x_hat - mean

    moved = plant @ np.array([x, v, f]) + np.outer(before, queue[-1])
    command = np.zeros(size)
    command[6] = 1.0  # into the queue
    if ticks:
        moved += np.outer(now, queue[ticks - 1])
    else:
        command[:3] = now
    model = a * f_hat + (1.0 - a) * p
    rows = np.vstack([moved, model, w_hat, remembered, np.zeros(size + 2), *queue[:-1]])
    n = size
    return LoopMatrices(rows[:, :n], command, p[:n], rows[:, n:], p[n:], u[:n], u[n:])


@lru_cache(maxsize=64)
def _plant(axis: Axis, delay: float) -> tuple[Array, Array, Array, int]:
    """Hull and thrust over one period, and what two commands add: the older until it is replaced.

    A delay of `ticks` periods and a rest: during the rest the command of `ticks + 1` ticks ago
    acts, then that of `ticks` ago.
    """
    h = axis.period
    ticks = int(delay / h + 1e-9)
    rest = max(delay - ticks * h, 0.0)
    whole, _ = _held(axis, h)
    late, now = _held(axis, h - rest)
    _, first = _held(axis, rest)
    return whole, late @ first, now, ticks


def _held(axis: Axis, time: float) -> tuple[Array, Array]:
    """Transition (3, 3) of (x, v, f) in a time, and the effect (3,) of a command of one held."""
    m = axis.inertia
    rates = np.zeros((4, 4))
    rates[0, 1] = 1.0
    rates[1, :2] = -axis.righting / m, -axis.drag / m
    if axis.lag > 0.0:
        rates[1, 2] = 1.0 / m
        rates[2, 2:] = -1.0 / axis.lag, 1.0 / axis.lag
    else:
        rates[1, 3] = 1.0 / m  # the thrust is the command, and f an idle state
    moved = _exponential(rates * time)
    if axis.lag <= 0.0:
        moved[2] = 0.0
    return moved[:3, :3], moved[:3, 3]


def _exponential(matrix: Array) -> Array:
    """Matrix exponential by Taylor's series, scaling and squaring."""
    size = float(np.abs(matrix).sum(axis=1).max())
    halvings = max(int(np.ceil(np.log2(2.0 * size))), 0) if size > 0.0 else 0
    small = matrix / 2.0**halvings
    result = term = np.eye(len(matrix))
    for k in range(1, TAYLOR_TERMS + 1):
        term = term @ small / k
        result = result + term
    for _ in range(halvings):
        result = result @ result
    return result


def _require(name: str, value: float, holds: bool, bound: str) -> None:
    if not holds:
        raise ControlSetupError(f"axis loop {name}: {value:g}, expected {bound}")
