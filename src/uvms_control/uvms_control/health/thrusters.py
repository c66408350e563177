"""Everything that the allocator does about its thrusters' health, around any allocation method."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from uvms_control.health.belief import ThrusterBelief
from uvms_control.health.diagnosis import AXES, ThrusterDiagnosis
from uvms_control.health.trial import TrialThrust
from uvms_control.vehicle_data import least_thrusts, thruster_limits
from uvms_core.diagnostics import Trouble
from uvms_core.signals import Allocation, Array, DisturbanceBudget, ThrusterCommand
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix

Told = tuple[ThrusterCommand, Allocation]


class Thrusters:
    """What is believed of a vehicle's thrusters, and what is made of it.

    Args:
        vehicle: its thrusters.
        configured: share of the command that they give, by name, as the user knows it.

    Raises:
        ControlSetupError: a name or a share that cannot be.
    """

    def __init__(self, vehicle: Vehicle, configured: Mapping[str, float]) -> None:
        self.belief = ThrusterBelief(vehicle.thruster_names, configured)
        self._matrix, limits = thruster_matrix(vehicle), thruster_limits(vehicle)[0]
        self._diagnosis = ThrusterDiagnosis(self._matrix, limits, self.belief)
        self._test = TrialThrust(limits, least_thrusts(vehicle))
        self._budget: DisturbanceBudget | None = None
        self._informed: tuple[Any, Any] = (None, None)  # who was told, and what

    def before(self, method: Any, budget: DisturbanceBudget | None) -> None:
        """Take the estimate of the tick before, and tell the method what is believed."""
        self._budget = budget
        self.belief.estimate(None if budget is None else budget.thrusters)
        informed = method, self.belief.effectiveness
        if informed[0] is self._informed[0] and informed[1] is self._informed[1]:
            return
        if tell := getattr(method, "set_effectiveness", None):
            tell(self.belief.effectiveness)
        self._informed = informed

    def after(self, told: Told) -> Told:
        """The method's answer with what the thrusters will really give, and with trial thrusts."""
        command, allocation = told
        shares = self.belief.effectiveness
        if allocation.effectiveness.size != shares.size:  # a method that does not know of health
            allocation = self._corrected(allocation)
        test = self._test.at(allocation.stamp, self.belief.untried)
        if test is not None:
            command = replace(command, thrust=command.thrust + test)
            allocation = replace(allocation, thrust=allocation.thrust + test)
        self._diagnosis.step(allocation, self._budget)
        return command, allocation

    def _corrected(self, allocation: Allocation) -> Allocation:
        shares = self.belief.effectiveness
        wanted = allocation.achieved + allocation.residual
        achieved = self._matrix @ (shares * allocation.thrust)
        return replace(
            allocation, achieved=achieved, residual=wanted - achieved, effectiveness=shares
        )

    def say(self, shares: Mapping[str, float]) -> str:
        """Take the user's word by thruster's name; NaN takes one back. Returns the `summary`.

        Raises:
            ControlSetupError: a name or a share that cannot be.
        """
        self.belief.say(shares)
        self._diagnosis.follow_belief()
        return self.summary

    @property
    def summary(self) -> str:
        """What is believed, and the authority that remains, in words."""
        weak = [
            f"{name} gives {share:.0%} ({self.belief.source(name)})"
            for name, share in self.belief.weak.items()
        ]
        left = [f"{axis} {share:.0%}" for axis, share in self.authority_shares().items()]
        return (
            f"{', '.join(weak) or 'all thrusters are whole'};"
            f" authority that remains: {', '.join(left)}"
        )

    @property
    def authority(self) -> Array:
        """Greatest force and moment along each axis alone (6,) with what is believed, N and N m."""
        return self._diagnosis.remaining

    def authority_shares(self) -> dict[str, float]:
        """Share of its authority that each axis has left; those that never had any are left out."""
        nominal, remaining = self._diagnosis.nominal, self._diagnosis.remaining
        return {
            axis: float(remaining[i] / nominal[i])
            for i, axis in enumerate(AXES)
            if nominal[i] > 0.0
        }

    def trouble(self) -> Trouble | None:
        """What is wrong, for /diagnostics."""
        return self._diagnosis.trouble()

    def status(self) -> dict[str, float]:
        """Shares of thrusters and authority, for /diagnostics."""
        return self._diagnosis.status()
