"""Which thruster gives less than it is told, by the evidence of the last seconds."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array, ThrusterHealth
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix
from uvms_dynamics.kernels.ambient import WATER_COLUMNS
from uvms_observer.health import evidence as columns
from uvms_observer.health.evidence import weigh
from uvms_observer.health.noise import NoiseLevel
from uvms_observer.health.verdict import Verdict, decide
from uvms_observer.lagged_thrusts import LaggedThrusts

ANOTHER_PERIOD = 2.5
"""The window begins anew where ticks are this many times further apart or closer: jitter and a tick
that is lost do not end what has been seen."""
WINDOW_S = 2.0
"""Within it a disturbance is taken to be constant but for what the water does to a hull that moves,
and a fault has to be told from both."""
ONSETS = 20
"""Onsets tried in a window: a tenth of a second apart."""
CONFIRM_S = 0.3
"""The same verdict for so long is believed: a coincidence of noise is shorter."""
FOLLOWS_S = (0.4, 1.5)
"""How soon and how late a controller answers a disturbance, s: two ticks, the estimate of the
disturbance (a bandwidth of some rad/s) and the lag of the thruster come first."""
PRIOR_SIGMA = 0.2
"""Of a thruster's share that no evidence has been seen of: data sheets and batteries."""
SEARCHED, LEAST_SIGMA = 3.0, 0.03
"""A share's std is that of the regression, so many times, since its onset was searched for and the
disturbance was not quite constant; and not below the errors of lag and curve."""
STILL = np.zeros((6, WATER_COLUMNS))
"""A vehicle at rest, to which the same current does the same all the time."""
SHARE_RANGE = (-0.2, 1.0)
"""Share of the command that may be missing: a thruster may give a fifth more than the file says."""


@dataclass(frozen=True)
class Fault:
    """A verdict that is believed.

    Attributes:
        thruster: its number.
        share: of its command that it lost beyond what was believed.
        thrusts: (k,) its lagged thrusts since the onset, N, oldest first.
    """

    thruster: int
    share: float
    thrusts: Array


class ThrusterMonitor:
    """Watches all thrusters of a vehicle.

    Args:
        vehicle: thruster matrix and lags.

    Attributes:
        health: as the last step found it; all whole before.
        found: the fault that the last step came to believe, if any.
        lagged: (m,) mean thrusts over the last interval, as commanded, N.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        self._matrix = np.ascontiguousarray(thruster_matrix(vehicle))
        self._lag = LaggedThrusts(vehicle)
        self._noise = NoiseLevel()
        self._m = self._matrix.shape[1]
        self._lost = np.zeros(self._m)
        self._sigma = np.full(self._m, PRIOR_SIGMA)
        self._evidence = np.zeros((self._m, columns.COLUMNS))
        self._dt = 0.0
        self.health = ThrusterHealth(np.ones(self._m), self._sigma.copy())
        self.found: Fault | None = None
        self.lagged = np.zeros(self._m)
        self._start(0.0)

    def _start(self, dt: float) -> None:
        """Empty windows, for ticks of dt s."""
        self._dt, self._size = dt, max(round(WINDOW_S / dt), 2) if dt > 0.0 else 2
        self._residuals = np.zeros((self._size, 6))
        self._thrusts = np.zeros((self._size, self._m))
        self._waters = np.zeros((self._size, *STILL.shape))
        self._count = 0
        self._doubt()

    def _doubt(self) -> None:
        """Nobody is suspected."""
        self._same, self._certain, self._candidate = 0, 0, Verdict()

    def step(
        self,
        dt: float,
        unexplained: Array,
        sigma: Array,
        thrust: Array,
        believed: Array,
        water: Array = STILL,
    ) -> ThrusterHealth:
        """What each thruster gives after another tick.

        Args:
            dt: since the last tick, s.
            unexplained: wrench (6,) that the motion over this tick needed beyond model and
                thrusters, N and N m, body frame.
            sigma: its standard deviation (6,), as far as it is known; zeros where it is not.
            thrust: commanded over this tick (m,), N.
            believed: share (m,) with which the thrusters were counted in `unexplained`; (0,): all.
            water: (6, 4) of `water_wrenches`: what a current and an error of the hydrodynamics may
                be of `unexplained`.
        """
        if not self._dt / ANOTHER_PERIOD < dt < self._dt * ANOTHER_PERIOD:
            self._start(dt)
        self.found = None
        self.lagged = lagged = self._lag.step(dt, thrust)
        whole = unexplained
        if believed.size:
            whole = unexplained - self._matrix @ ((1.0 - believed) * lagged)
        weights = self._noise.step(dt, whole + self._matrix @ (self._lost * lagged), sigma)
        self._push(whole, lagged, water)
        if self._count * 2 >= self._size:
            self._judge(weights)
        self.health = self._state()
        return self.health

    def _push(self, *tick: Array) -> None:
        for window, value in zip((self._residuals, self._thrusts, self._waters), tick, strict=True):
            window[:-1] = window[1:]
            window[-1] = value
        self._count = min(self._count + 1, self._size)

    def _judge(self, weights: Array) -> None:
        """Weigh the window, and believe a verdict that has stood for long enough."""
        first = self._size - self._count
        thrusts = self._thrusts[first:]
        left = self._residuals[first:] + (self._lost * thrusts) @ self._matrix.T
        low, high = SHARE_RANGE[0] - self._lost, SHARE_RANGE[1] - self._lost
        step = max(self._size // ONSETS, 1)
        lags = (max(round(FOLLOWS_S[0] / self._dt), 1), max(round(FOLLOWS_S[1] / self._dt), 1))
        water, matrix = self._waters[first:], self._matrix
        weigh(left, thrusts, water, matrix, weights, low, high, step, lags, self._evidence)
        verdict = decide(self._evidence, self._lost)
        stands = verdict.thruster >= 0 and verdict.thruster == self._candidate.thruster
        self._same = self._same + 1 if stands else 0
        self._certain = self._certain + 1 if stands and verdict.certain else 0
        self._candidate = verdict
        if verdict.certain and self._certain * self._dt >= CONFIRM_S:
            self._believe(verdict)

    def _believe(self, verdict: Verdict) -> None:
        """Take a thruster's new share, and look at the rest from the fault's onset on."""
        i, before = verdict.thruster, self._lost[verdict.thruster]
        self._lost[i] = min(max(before + verdict.share, SHARE_RANGE[0]), SHARE_RANGE[1])
        self._sigma[i] = max(SEARCHED * verdict.sigma, LEAST_SIGMA)
        since = self._thrusts[self._size - self._count + verdict.onset :, i].copy()
        self.found = Fault(i, float(self._lost[i] - before), since)
        self._count = max(self._count - verdict.onset, 1)
        self._doubt()

    def _state(self) -> ThrusterHealth:
        """Shares and their std; a suspect's loss is as uncertain as it is large."""
        left, sigma = 1.0 - self._lost, self._sigma.copy()
        if self._same * self._dt >= CONFIRM_S:
            i, share = self._candidate.thruster, self._candidate.share
            left[i] = max(left[i] - share, 1.0 - SHARE_RANGE[1])
            sigma[i] = max(abs(share), sigma[i])
        return ThrusterHealth(left, sigma)
