"""The motion planner as a part of the loop."""

from collections.abc import Iterator

from uvms_core import topics
from uvms_core.part import Output, Part
from uvms_core.signals import JointStates, Odometry, to_nanoseconds
from uvms_core.tick_gate import CompanionBefore, Delayed, Same, Tick, held
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

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int, period: int) -> None:
        self._arguments = vehicle, config, seed
        self.planner = MotionPlanner(vehicle, config, seed)
        self.every = to_nanoseconds(config.step_s)
        self.inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Delayed(),
            topics.DISTURBANCE_BUDGET: CompanionBefore(period),
        }
        self.plan: PlannerStep | None = None
        self._state: tuple[Odometry, JointStates] | None = None

    def step(self, tick: Tick) -> Iterator[Output]:
        """One planner step; `plan` holds all of it until the next one."""
        odometry, joints = tick[topics.ODOMETRY.name], tick[topics.JOINT_STATES.name]
        self.plan = None
        if (budget := tick[topics.DISTURBANCE_BUDGET.name]) is not None:
            self.planner.inform(budget)
        self.plan = self.planner.step(tick.stamp, odometry, joints)
        self._state = odometry, joints
        for reference in self.plan.references:
            yield topics.REFERENCE, reference

    def restart(self, reason: str) -> None:
        """A planner that holds the pose of its next tick; a goal in progress is given up."""
        before, self.planner = self.planner, MotionPlanner(*self._arguments)
        for _ in range(before.answers_owed):
            self.planner.give_up(f"the planner restarted: {reason}")

    def safe(self, tick: Tick) -> Iterator[Output]:
        """The plan goes on, or holds, by the last state that could be used."""
        self.plan = None
        state = self._state if self._state is not None else (None, None)
        odometry = tick[topics.ODOMETRY.name] or state[0]
        joints = tick[topics.JOINT_STATES.name] or state[1]
        if odometry is None or joints is None:
            return
        self.plan = self.planner.step(
            tick.stamp, held(odometry, tick.stamp), held(joints, tick.stamp)
        )
        for reference in self.plan.references:
            yield topics.REFERENCE, reference
