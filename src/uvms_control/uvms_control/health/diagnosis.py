"""What /diagnostics says of thrusters: who is weak, what axes are lost, what cannot be held."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from uvms_control.controlled_axes import AXES
from uvms_control.health.authority import lost_axes, remaining_authority
from uvms_control.health.belief import ThrusterBelief
from uvms_control.health.lasting import Lasting
from uvms_core.diagnostics import ERROR, WARN, Trouble
from uvms_core.signals import Allocation, Array, DisturbanceBudget

SATURATED_S = 3.0
"""A thruster at its limit for so long without a break is told: it turns round within 0.5 s, and the
start of a motion is over within that time."""
MISSING_SHARE, MISSING_S = 0.1, 2.0
"""An axis of which more than this share of its authority is missing for so long is not held."""
DRIFT_SHARE, DRIFT_S = 0.003, 3.0
"""A lost axis along which something pushes with more than this share of what the thrusters had is
not held by the hull either, however slowly it drifts."""
DRIFT_SIGMAS = 3.0
"""The push must also be so many of its standard deviations."""


class ThrusterDiagnosis:
    """Follows the allocation, and puts it into words.

    Args:
        matrix: wrench of one newton of each thruster (6, m).
        limits: greatest thrusts astern and ahead (2, m), N.
        belief: of the thrusters' shares.
    """

    def __init__(self, matrix: Array, limits: Array, belief: ThrusterBelief) -> None:
        self._matrix, self._limits, self._belief = matrix, limits, belief
        self.nominal = remaining_authority(matrix, limits, np.ones(matrix.shape[1]))
        self._shares = np.empty(0)
        self.remaining = self.nominal
        """Authority (6,) with what is believed, N and N m."""
        self.lost: NDArray[np.bool_] = np.zeros(6, dtype=np.bool_)
        """Axes (6,) along which nothing can be pushed any more."""
        self._saturated = Lasting(SATURATED_S)
        self._missing = Lasting(MISSING_S)
        self._drifting = Lasting(DRIFT_S)
        self._asked = False

    def step(self, allocation: Allocation, budget: DisturbanceBudget | None) -> None:
        """Look at an allocation, and at what acts on the vehicle by the tick before."""
        self.follow_belief()
        stamp, scale = allocation.stamp, np.where(self.nominal > 0.0, self.nominal, np.inf)
        self._saturated.step(stamp, allocation.saturated)
        missing = np.abs(allocation.residual) > MISSING_SHARE * scale
        self._missing.step(stamp, missing & ~self.lost)
        self._drifting.step(stamp, self.lost & self._is_pushed(allocation, budget, scale))
        self._asked = bool(self.lost.any()) and (self._asked or bool(self._drifting.flags.any()))

    def follow_belief(self) -> None:
        """Work out the authority of what is believed now, where that has changed."""
        shares = self._belief.effectiveness
        if shares is self._shares:
            return
        self._shares = shares
        self.remaining = remaining_authority(self._matrix, self._limits, shares)
        self.lost = lost_axes(self.remaining, self.nominal)

    def _is_pushed(
        self, allocation: Allocation, budget: DisturbanceBudget | None, scale: Array
    ) -> NDArray[np.bool_]:
        """Axes (6,) along which a wrench is asked for, or seen, that the thrusters cannot give."""
        push, least = np.abs(allocation.residual), DRIFT_SHARE * scale
        if budget is None:
            return push > least
        seen = np.abs(budget.external)
        return (push > least) | (seen > np.maximum(least, DRIFT_SIGMAS * budget.external_sigma))

    def trouble(self) -> Trouble | None:
        """The worst of what there is to tell, all of it in words."""
        found = list(self._found())
        if not found:
            return None
        return Trouble(max(level for level, _ in found), "; ".join(text for _, text in found))

    def _found(self) -> Iterator[Trouble]:
        for name, share in self._belief.weak.items():
            source = self._belief.source(name)
            yield Trouble(WARN, f"{name} gives {share:.0%} of its command ({source})")
        if self.lost.any():
            yield Trouble(ERROR, f"{_axes(self.lost)} lost: left to the hull")
        if self._asked:
            yield Trouble(ERROR, "the vehicle cannot hold it: abort the task")
        for name in self._belief.suspected:
            yield Trouble(WARN, self._suspicion(name))
        if (axes := self._missing.flags).any():
            # A gust or a load beyond the thrusters, which may pass: nothing has failed.
            text = f"{_axes(axes)}: not achieved for more than {MISSING_S:g} s"
            yield Trouble(WARN, text)
        if (flags := self._saturated.flags).any():
            names = [name for name, one in zip(self._belief.names, flags, strict=True) if one]
            yield Trouble(WARN, f"{', '.join(names)} at the limit for more than {SATURATED_S:g} s")

    def _suspicion(self, name: str) -> str:
        """Who is suspected, and what it would mean if the thruster were dead."""
        shares = self._belief.effectiveness.copy()
        shares[self._belief.names.index(name)] = 0.0
        remaining = remaining_authority(self._matrix, self._limits, shares)
        axes = lost_axes(remaining, self.nominal) & ~self.lost
        means = f": without it {_axes(axes)} would be lost" if axes.any() else ""
        return f"{name} is suspected to give less than its command{means}"

    def status(self) -> dict[str, float]:
        """Shares of the thrusters and of the authority that remains, by name."""
        shares = zip(self._belief.names, self._belief.effectiveness.tolist(), strict=True)
        values = {f"effectiveness_{name}": share for name, share in shares}
        had = np.where(self.nominal > 0.0, self.nominal, 1.0)
        return values | {
            f"authority_{axis}": share
            for axis, share in zip(AXES, (self.remaining / had).tolist(), strict=True)
        }


def _axes(flags: NDArray[np.bool_]) -> str:
    return " and ".join(axis for axis, flag in zip(AXES, flags, strict=True) if flag)
