"""The closed loop in one process, without ROS: the nodes' own core classes in the graph's order."""

import time
from dataclasses import dataclass

from uvms_bringup.scenario import Scenario
from uvms_control import Controller, ThrustAllocator
from uvms_core.signals import (
    Allocation,
    DisturbanceBudget,
    JointCommand,
    Odometry,
    Reference,
    ThrusterCommand,
    Wrench,
    to_nanoseconds,
)
from uvms_core.tick_gate import Covering
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation import Plant
from uvms_dynamics.simulation.plant import PlantTruth, SensorFrame
from uvms_observer import DisturbanceObserver, NavigationFilter
from uvms_planner import MotionPlanner, PlannerStep


@dataclass(frozen=True)
class LoopTick:
    """Every signal of one control tick."""

    stamp: int
    sensors: SensorFrame
    truth: PlantTruth
    odometry: Odometry
    budget: DisturbanceBudget
    disturbance: Wrench
    plan: PlannerStep | None
    plan_ms: float  # wall time of the planner's step
    reference: Reference
    wrench: Wrench
    joint_command: JointCommand
    thruster_command: ThrusterCommand
    allocation: Allocation


class Loop:
    """Sensors, navigation, planner, observer, controller, allocator and plant, tick by tick."""

    def __init__(self, scenario: Scenario, vehicle: Vehicle) -> None:
        self.plant = Plant(vehicle, scenario.plant, scenario.seed)
        self.navigation = NavigationFilter(vehicle, scenario.navigation)
        self.observer = DisturbanceObserver(vehicle, scenario.observer)
        self.planner = MotionPlanner(vehicle, scenario.planner, scenario.seed)
        self.controller = Controller(vehicle, scenario.control)
        self.allocator = ThrustAllocator(vehicle, scenario.allocation)
        self._planner_step = to_nanoseconds(scenario.planner.step_s)
        self._references = Covering()
        self._achieved: Wrench | None = None

    def tick(self) -> LoopTick:
        """Everything that the graph computes at the plant's present stamp."""
        stamp, sensors, truth = self.plant.stamp, self.plant.sense(), self.plant.truth()
        odometry = self.navigation.step(stamp, **sensors.samples)
        began = time.perf_counter()
        plan = self._plan(stamp, odometry, sensors)
        plan_ms = 1e3 * (time.perf_counter() - began)
        budget, disturbance = self.observer.step(odometry, sensors.joints, self._achieved)
        reference = self._references.take(stamp)
        wrench, joint_command = self.controller.step(
            odometry, sensors.joints, disturbance, reference
        )
        thruster_command, allocation = self.allocator.step(wrench)
        self._achieved = Wrench(stamp, allocation.achieved)
        return LoopTick(
            stamp, sensors, truth, odometry, budget, disturbance, plan, plan_ms, reference,
            wrench, joint_command, thruster_command, allocation,
        )  # fmt: skip

    def advance(self, tick: LoopTick) -> None:
        """Let the plant move to its next tick under the commands of this one."""
        self.plant.step(tick.thruster_command, tick.joint_command)

    def _plan(self, stamp: int, odometry: Odometry, sensors: SensorFrame) -> PlannerStep | None:
        if stamp % self._planner_step:
            return None
        plan = self.planner.step(stamp, odometry, sensors.joints)
        for reference in plan.references:
            self._references.push(reference.stamp, reference)
        return plan
