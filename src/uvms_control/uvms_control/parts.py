"""Controller and thrust allocator as parts of the loop."""

from collections.abc import Iterator, Mapping

import numpy as np

from uvms_control.config import AllocatorConfig, ControlConfig
from uvms_control.health import Thrusters
from uvms_control.interfaces import AllocationMethod, ControlLaw
from uvms_core import topics
from uvms_core.diagnostics import Trouble
from uvms_core.part import Output, Part
from uvms_core.plugin import create, prepared
from uvms_core.signals import Allocation, JointCommand, ThrusterCommand, Wrench
from uvms_core.tick_gate import Companion, CompanionBefore, Covering, Delayed, Same, Tick
from uvms_core.vehicle import Vehicle


class ControllerPart(Part):
    """Estimated state, reference and disturbance in; wrench and joint command out."""

    trigger = topics.ODOMETRY
    outputs = topics.NODES[topics.CONTROLLER].outputs
    left_to_reader = (topics.JOINT_COMMAND,)  # the plant has brakes

    def __init__(self, vehicle: Vehicle, config: ControlConfig, period: int) -> None:
        self._vehicle, self._config, self._period = vehicle, config, period
        self.law = self._make_law()
        self.inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Delayed(),
            topics.DISTURBANCE: Same(),
            topics.DISTURBANCE_BUDGET: Companion(),
            topics.REFERENCE: Covering(),
            topics.ALLOCATION: CompanionBefore(period),
        }

    def step(self, tick: Tick) -> Iterator[Output]:
        """One step of the law."""
        if inform := getattr(self.law, "inform", None):
            inform(tick[topics.DISTURBANCE_BUDGET.name], tick[topics.ALLOCATION.name])
        wrench, joints = self.law.step(
            tick[topics.ODOMETRY.name],
            tick[topics.JOINT_STATES.name],
            tick[topics.DISTURBANCE.name],
            tick[topics.REFERENCE.name],
        )
        yield topics.WRENCH_COMMAND, wrench
        yield topics.JOINT_COMMAND, joints
        if (stability := getattr(self.law, "stability", None)) is not None:
            yield topics.STABILITY, stability

    def restart(self, reason: str) -> None:
        """The law restarts: its integrals and filters are gone."""
        self.law = self._make_law()

    def _make_law(self) -> ControlLaw:
        law: ControlLaw = prepared(create(self._config, self._vehicle), self._period)
        return law

    def safe(self, tick: Tick) -> Iterator[Output]:
        """No wrench and no torque."""
        yield topics.WRENCH_COMMAND, Wrench(tick.stamp, np.zeros(6))
        yield topics.JOINT_COMMAND, JointCommand(tick.stamp, np.zeros(self._vehicle.n_joints))


class AllocatorPart(Part):
    """Commanded wrench in; thrusts and the wrench that they achieve out."""

    trigger = topics.WRENCH_COMMAND
    outputs = topics.NODES[topics.THRUST_ALLOCATOR].outputs

    def __init__(self, vehicle: Vehicle, config: AllocatorConfig, period: int) -> None:
        self._vehicle, self._config, self._period = vehicle, config, period
        self.method: AllocationMethod = prepared(create(config, vehicle), period)
        self.thrusters = Thrusters(vehicle, config.effectiveness)
        self.inputs = {
            topics.WRENCH_COMMAND: Same(),
            topics.DISTURBANCE_BUDGET: CompanionBefore(period),
        }

    def step(self, tick: Tick) -> Iterator[Output]:
        """One allocation, with the thrusters as they are believed to be."""
        budget = tick[topics.DISTURBANCE_BUDGET.name]
        if inform := getattr(self.method, "inform", None):
            inform(budget)
        self.thrusters.before(self.method, budget)
        told = self.method.step(tick[topics.WRENCH_COMMAND.name])
        command, allocation = self.thrusters.after(told)
        yield topics.THRUSTER_COMMAND, command
        yield topics.WRENCH_ACHIEVED, Wrench(tick.stamp, allocation.achieved)
        yield topics.ALLOCATION, allocation

    def restart(self, reason: str) -> None:
        """The method restarts, without a thrust before; what the user said stays."""
        self.method = prepared(create(self._config, self._vehicle), self._period)

    def trouble(self) -> Trouble | None:
        """Weak thrusters, lost axes, and what cannot be held."""
        return self.thrusters.trouble()

    def status(self) -> Mapping[str, float]:
        """Share that each thruster gives, and share of its authority that each axis has."""
        return self.thrusters.status()

    def safe(self, tick: Tick) -> Iterator[Output]:
        """No thrust; a method that has a `safe` of its own says what that is."""
        if safe := getattr(self.method, "safe", None):
            command, allocation = safe(tick.stamp)
            yield topics.THRUSTER_COMMAND, command
            yield topics.WRENCH_ACHIEVED, Wrench(tick.stamp, allocation.achieved)
            yield topics.ALLOCATION, allocation
            return
        thrust, none = np.zeros(self._vehicle.n_thrusters), np.zeros(6)
        yield topics.THRUSTER_COMMAND, ThrusterCommand(tick.stamp, thrust)
        yield topics.WRENCH_ACHIEVED, Wrench(tick.stamp, none)
        unsaturated = np.zeros(self._vehicle.n_thrusters, dtype=np.bool_)
        shares = self.thrusters.belief.effectiveness
        allocation = Allocation(tick.stamp, thrust, none, none, unsaturated, shares)
        yield topics.ALLOCATION, allocation
