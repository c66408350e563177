"""The closed loop in one process, without ROS: the nodes' own parts in the graph's order."""

import gc
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from uvms_bringup.scenario import Scenario
from uvms_control.parts import AllocatorPart, ControllerPart
from uvms_core import topics
from uvms_core.attitude import attitude_status
from uvms_core.battery import battery_status
from uvms_core.diagnostics import Status, together
from uvms_core.part import InProcess, Output, Part
from uvms_core.plausibility import Plausibility
from uvms_core.signals import (
    Allocation,
    DisturbanceBudget,
    JointCommand,
    Odometry,
    ThrusterCommand,
    Wrench,
    to_nanoseconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation import Plant, PlantTruth, SensorFrame
from uvms_dynamics.simulation.events import status_values
from uvms_dynamics.simulation.publication import plant_outputs
from uvms_dynamics.simulation.sensors.suite import in_order_of_publication
from uvms_observer.parts import ObserverPart, navigation_part
from uvms_planner import MotionPlanner, PlannerStep
from uvms_planner.part import PlannerPart


@dataclass(frozen=True)
class LoopTick:
    """Every signal of one control tick."""

    stamp: int
    sensors: SensorFrame
    truth: PlantTruth
    outputs: list[Output]  # in the order of publication
    step_ms: Mapping[str, float]  # wall time of each part's step, by role
    plan: PlannerStep | None  # where this tick is one of the planner's

    def newest(self, topic: topics.Topic) -> Any:
        """The last signal of this tick on a topic; None if there was none."""
        for each, signal in reversed(self.outputs):
            if each is topic:
                return signal
        return None

    @property
    def odometry(self) -> Odometry:
        """Estimated pose and velocity."""
        return self.newest(topics.ODOMETRY)

    @property
    def budget(self) -> DisturbanceBudget:
        """Observed disturbance in its parts."""
        return self.newest(topics.DISTURBANCE_BUDGET)

    @property
    def disturbance(self) -> Wrench:
        """Observed disturbance as it is fed forward."""
        return self.newest(topics.DISTURBANCE)

    @property
    def wrench(self) -> Wrench:
        """Commanded wrench."""
        return self.newest(topics.WRENCH_COMMAND)

    @property
    def joint_command(self) -> JointCommand:
        """Commanded joint torques."""
        return self.newest(topics.JOINT_COMMAND)

    @property
    def thruster_command(self) -> ThrusterCommand:
        """Commanded thrusts."""
        return self.newest(topics.THRUSTER_COMMAND)

    @property
    def allocation(self) -> Allocation:
        """Thrusts, achieved wrench and residual."""
        return self.newest(topics.ALLOCATION)


@cache
def _spare_the_garbage_collector() -> None:
    """Once: what the libraries have made so far lives for good, and need not be visited again.

    numba's objects are so many that visiting them again and again slows a run.
    """
    gc.collect()
    gc.freeze()


def make_parts(scenario: Scenario, vehicle: Vehicle) -> dict[str, Part]:
    """The parts of a scenario's loop besides the plant, by role."""
    period = to_nanoseconds(scenario.plant.control_period_s)
    return {
        topics.NAVIGATION: navigation_part(vehicle, scenario.navigation, period),
        topics.MOTION_PLANNER: PlannerPart(vehicle, scenario.planner, scenario.seed, period),
        topics.DISTURBANCE_OBSERVER: ObserverPart(vehicle, scenario.observer, period),
        topics.CONTROLLER: ControllerPart(vehicle, scenario.control, period),
        topics.THRUST_ALLOCATOR: AllocatorPart(vehicle, scenario.allocation, period),
    }


class Loop:
    """Sensors, navigation, planner, observer, controller, allocator and plant, tick by tick."""

    def __init__(self, scenario: Scenario, vehicle: Vehicle) -> None:
        self.plant = Plant(vehicle, scenario.plant, scenario.seed, scenario.events)
        self.parts = make_parts(scenario, vehicle)
        self._process = InProcess(self.parts, Plausibility(vehicle))
        self._sensor_topics = in_order_of_publication(vehicle)
        _spare_the_garbage_collector()

    @property
    def planner(self) -> MotionPlanner:
        """Takes goals."""
        return self.parts[topics.MOTION_PLANNER].planner  # type: ignore[attr-defined]

    def tick(self) -> LoopTick:
        """Everything that the graph computes at the plant's present stamp."""
        stamp, sensors, truth = self.plant.stamp, self.plant.sense(), self.plant.truth()
        outputs = list(plant_outputs(stamp, sensors, truth, self._sensor_topics))
        outputs += self._happened()
        step_ms: dict[str, float] = {}
        with np.errstate(all="ignore"):  # what overflows is refused, and is no news
            self._process.admit_all(outputs[1:])  # the clock is a stamp, not a signal
            began = time.perf_counter()
            for role, own in self._process.tick(stamp):
                ended = time.perf_counter()
                step_ms[role], began = 1e3 * (ended - began), ended
                outputs += own
        plan = self.parts[topics.MOTION_PLANNER].plan if topics.MOTION_PLANNER in step_ms else None  # type: ignore[attr-defined]
        return LoopTick(stamp, sensors, truth, outputs, step_ms, plan)

    def _happened(self) -> Iterator[Output]:
        """What has happened to the plant, as its node reports it."""
        if happened := self.plant.take_happened():
            values = status_values(happened)
            yield topics.DIAGNOSTICS, Status(self.plant.stamp, topics.PLANT, values=values)

    def final_status(self, tick: LoopTick) -> Iterator[Status]:
        """What the plant and every part have to say at the last tick, as nodes do each second."""
        said = together(
            attitude_status(tick.truth.odometry.quaternion),
            battery_status(self.plant.battery_share),
        )
        yield Status(tick.stamp, topics.PLANT, *said, {"lockstep_timeouts": 0})
        yield from self._process.final_status(tick.stamp)

    def advance(self, tick: LoopTick) -> None:
        """Let the plant move to its next tick under the commands of this one that it may use."""
        usable = self._process.is_usable
        thrust, effort = tick.thruster_command, tick.joint_command
        self.plant.step(
            thrust if usable(topics.THRUSTER_COMMAND, thrust) else None,
            effort if usable(topics.JOINT_COMMAND, effort) else None,
        )
