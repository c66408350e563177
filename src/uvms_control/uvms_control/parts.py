"""Controller and thrust allocator as parts of the loop."""

from collections.abc import Iterator

from uvms_control.config import AllocatorConfig, ControlConfig
from uvms_control.interfaces import AllocationMethod, ControlLaw
from uvms_core import topics
from uvms_core.part import Output, Part
from uvms_core.plugin import create
from uvms_core.signals import Wrench
from uvms_core.tick_gate import Covering, Same, Tick
from uvms_core.vehicle import Vehicle


class ControllerPart(Part):
    """Estimated state, reference and disturbance in; wrench and joint command out."""

    trigger = topics.ODOMETRY
    outputs = topics.NODES[topics.CONTROLLER].outputs

    def __init__(self, vehicle: Vehicle, config: ControlConfig) -> None:
        self.law: ControlLaw = create(config, vehicle)
        self.inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Same(),
            topics.DISTURBANCE: Same(),
            topics.REFERENCE: Covering(),
        }

    def step(self, tick: Tick) -> Iterator[Output]:
        """One step of the law."""
        wrench, joints = self.law.step(
            tick[topics.ODOMETRY.name],
            tick[topics.JOINT_STATES.name],
            tick[topics.DISTURBANCE.name],
            tick[topics.REFERENCE.name],
        )
        yield topics.WRENCH_COMMAND, wrench
        yield topics.JOINT_COMMAND, joints


class AllocatorPart(Part):
    """Commanded wrench in; thrusts and the wrench that they achieve out."""

    trigger = topics.WRENCH_COMMAND
    outputs = topics.NODES[topics.THRUST_ALLOCATOR].outputs

    def __init__(self, vehicle: Vehicle, config: AllocatorConfig) -> None:
        self.method: AllocationMethod = create(config, vehicle)
        self.inputs = {topics.WRENCH_COMMAND: Same()}

    def step(self, tick: Tick) -> Iterator[Output]:
        """One allocation."""
        command, allocation = self.method.step(tick[topics.WRENCH_COMMAND.name])
        yield topics.THRUSTER_COMMAND, command
        yield topics.WRENCH_ACHIEVED, Wrench(tick.stamp, allocation.achieved)
        yield topics.ALLOCATION, allocation
