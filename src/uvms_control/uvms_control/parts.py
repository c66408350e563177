"""Controller and thrust allocator as parts of the loop."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from uvms_control.arm_hold import ArmHold
from uvms_control.arm_law import ArmLaw
from uvms_control.config import AllocatorConfig, ControlConfig
from uvms_control.health import Thrusters
from uvms_control.interfaces import AllocationMethod, ControlLaw
from uvms_core import topics
from uvms_core.diagnostics import Trouble
from uvms_core.errors import UvmsError
from uvms_core.part import Output, Part
from uvms_core.plugin import create, prepared
from uvms_core.signals import (
    Allocation,
    JointCommand,
    JointStates,
    ThrusterCommand,
    Wrench,
    to_seconds,
)
from uvms_core.tick_gate import Companion, CompanionBefore, Covering, Delayed, Same, Tick
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model
from uvms_dynamics.payload import LoadedModel


class ControllerPart(Part):
    """Estimated state, reference and disturbance in; wrench and joint command out."""

    trigger = topics.ODOMETRY
    outputs = topics.NODES[topics.CONTROLLER].outputs

    def __init__(self, vehicle: Vehicle, config: ControlConfig, period: int) -> None:
        self._vehicle, self._config, self._period = vehicle, config, period
        self.law = self._make_law()
        self._is_held = False  # the arm, by the last safe output
        self._own_hold: ArmHold | None = None  # of a law that has none, while it lasts
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
        self._own_hold = None
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
        """No wrench; the arm stays where it is, or has no torque where its joints are not known."""
        yield topics.WRENCH_COMMAND, Wrench(tick.stamp, np.zeros(6))
        held = self._held(tick)
        self._is_held = held is not None
        none = JointCommand(tick.stamp, np.zeros(self._vehicle.n_joints))
        yield topics.JOINT_COMMAND, held or none

    def _held(self, tick: Tick) -> JointCommand | None:
        joints, hold = tick[topics.JOINT_STATES.name], getattr(self.law, "hold", None)
        if joints is None:
            return None
        try:
            command: JointCommand = (hold or self._without_law)(joints, tick.stamp)
        except (UvmsError, np.linalg.LinAlgError, OverflowError, FloatingPointError):
            return None
        return command if np.isfinite(command.effort).all() else None

    def _without_law(self, joints: JointStates, stamp: int) -> JointCommand:
        if self._own_hold is None:
            arm = ArmLaw(self._vehicle, LoadedModel(build_model(self._vehicle)), self._config)
            arm.prepare(to_seconds(self._period))
            self._own_hold = ArmHold(self._vehicle, arm)
        return self._own_hold.step(joints, stamp)

    @property
    def left_to_reader(self) -> Sequence[Topic]:  # type: ignore[override]
        """No torque is left to the plant, which has brakes; what holds the arm is not."""
        return () if self._is_held else (topics.JOINT_COMMAND,)


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
