"""The motion planner as a part of the loop."""

from collections.abc import Iterator

from uvms_core import topics
from uvms_core.part import Output, Part
from uvms_core.signals import to_nanoseconds
from uvms_core.tick_gate import Same, Tick
from uvms_core.vehicle import Vehicle
from uvms_planner.config import PlannerConfig
from uvms_planner.planner import MotionPlanner
from uvms_planner.report import PlannerStep


class PlannerPart(Part):
    """Estimated state in; references a planner step ahead out.

    The plant does not wait for it: the reference of a tick was published a step before.
    """

    trigger = topics.ODOMETRY
    outputs = topics.NODES[topics.MOTION_PLANNER].outputs
    in_loop = False

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int) -> None:
        self.planner = MotionPlanner(vehicle, config, seed)
        self.every = to_nanoseconds(config.step_s)
        self.inputs = {topics.ODOMETRY: Same(), topics.JOINT_STATES: Same()}
        self.plan: PlannerStep | None = None

    def step(self, tick: Tick) -> Iterator[Output]:
        """One planner step; `plan` holds all of it until the next one."""
        self.plan = self.planner.step(
            tick.stamp, tick[topics.ODOMETRY.name], tick[topics.JOINT_STATES.name]
        )
        for reference in self.plan.references:
            yield topics.REFERENCE, reference
