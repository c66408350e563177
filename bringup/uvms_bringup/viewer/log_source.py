"""A log as the source of a scene: any of its moments, looked up in the file."""

from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.clearance import run_obstacles
from uvms_analysis.errors import LogError
from uvms_analysis.happened import events_of
from uvms_analysis.log.instants import Instants
from uvms_analysis.log.locate import log_path
from uvms_analysis.log.read import RunLog
from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.moment import Forces, Moment, Posture, Thrusts
from uvms_bringup.viewer.overview import Overview
from uvms_bringup.viewer.scene_model import Setting
from uvms_bringup.viewer.water import current_of
from uvms_core import topics
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import NANOSECONDS, Array, Reference, to_nanoseconds, to_seconds

AGE_S = 1.0
"""A signal of every tick that is older counts no more."""
PLAN_AGE_S = 2.0
"""The same for a reference, which comes with each step of the planner."""
WANTED = {
    topics.TRUE_ODOMETRY: AGE_S,
    topics.TRUE_JOINT_STATES: AGE_S,
    topics.ODOMETRY: AGE_S,
    topics.JOINT_STATES: AGE_S,
    topics.APPLIED_THRUST: AGE_S,
    topics.ALLOCATION: AGE_S,
    topics.TRUE_DISTURBANCE: AGE_S,
    topics.DISTURBANCE_BUDGET: AGE_S,
    topics.REFERENCE: PLAN_AGE_S,
    topics.END_EFFECTOR_TARGET: AGE_S,
}
POSES = topics.TRUE_ODOMETRY, topics.ODOMETRY
INSTANTS = 400
"""Of the overview, evenly over the run."""
ASKED_POINTS = 300
"""Of the line along the path of the goal."""


class LogSource:
    """The moments of a log, and what is the same in all of them.

    Args:
        path: log of a run, or its folder.

    Raises:
        LogError: there is no such log, or it lacks vehicle or poses.
    """

    def __init__(self, path: str | Path) -> None:
        self.log = RunLog.open(log_path(path))
        self.vehicle = self.log.vehicle
        self._instants = Instants(self.log, WANTED)
        if not self._instants.names & {topic.name for topic in POSES}:
            raise LogError(
                f"log {self.log.path}: has neither {topics.ODOMETRY.name} nor"
                f" {topics.TRUE_ODOMETRY.name}, so there is nothing to look at"
            )
        self._current = current_of(self.log)
        self.start_s = to_seconds(self._instants.first)
        self.end_s = self._end()

    @property
    def name(self) -> str:
        """What the run is called."""
        return self.log.run.get("scenario", self.log.path.stem)

    def check_span(self, start: float, end: float) -> None:
        """Raises ViewError unless these times, in s, lie in the run in this order."""
        if not self.start_s <= start <= end <= self.end_s:
            raise ViewError(
                f"{start:g} to {end:g} s: {self.name} goes from {self.start_s:g} to"
                f" {self.end_s:g} s"
            )

    def moment(self, time: float) -> Moment:
        """What is known at a time in s."""
        moment = self._moment(time)
        if moment.thrusts is None:
            return moment
        over, turned = self.overview.times, self.overview.turned
        angles = np.array([np.interp(time, over, column) for column in turned.T])
        return replace(moment, thrusts=replace(moment.thrusts, turned=angles))

    @cached_property
    def overview(self) -> Overview:
        """The run at `INSTANTS` times."""
        times = np.linspace(self.start_s, self.end_s, INSTANTS)
        return Overview(self.vehicle, [self._moment(float(time)) for time in times])

    @cached_property
    def setting(self) -> Setting:
        """The scene of the run."""
        over = self.overview
        known = np.isfinite(over.tool).all(axis=1)
        return Setting(
            self.vehicle,
            run_obstacles(self.log),
            self._asked_points(),
            over.times[known],
            over.tool[known],
            over.force_scale,
            over.middle,
        )

    @cached_property
    def events(self) -> list[tuple[float, str]]:
        """Time in s and text of what happened in the run."""
        return [(float(event["at_s"]), event["text"]) for event in events_of(self.log)]

    @cached_property
    def _path(self) -> tuple[EndEffectorPath, float] | None:
        """The goal's path and when it begins, s."""
        run = Analysis(self.log)
        return None if run.path is None else (EndEffectorPath(run.path), run.path_start_s)

    def _end(self) -> float:
        """When the vehicle was last heard of, s: references are stamped ahead of it."""
        said = self._instants.at(self._instants.last)
        poses = [said[topic.name].stamp for topic in POSES if topic.name in said]
        return to_seconds(max(poses, default=self._instants.last))

    def _asked_points(self) -> Array | None:
        if self._path is None:
            return None
        curve, _ = self._path
        return np.asarray(curve.positions(np.linspace(0.0, curve.duration, ASKED_POINTS)))

    def _moment(self, time: float) -> Moment:
        said = self._instants.at(to_nanoseconds(time))
        estimate = said.get(topics.ODOMETRY.name)
        reference = said.get(topics.REFERENCE.name)
        return Moment(
            time,
            true=posture_of(said, topics.TRUE_ODOMETRY.name, topics.TRUE_JOINT_STATES.name),
            estimated=posture_of(said, topics.ODOMETRY.name, topics.JOINT_STATES.name),
            covariance=None if estimate is None else estimate.pose_covariance,
            thrusts=thrusts_of(said),
            forces=forces_of(said),
            plan=plan_of(reference, time),
            target=self._target(said, time),
            current=None if self._current is None else self._current(time),
        )

    def _target(self, said: dict[str, Any], time: float) -> Array | None:
        """On the goal's path while that runs, else where the tool is led or planned to be."""
        if self._path is not None:
            curve, start = self._path
            if start <= time <= start + curve.duration:
                return np.asarray(curve.positions(np.array([time - start]))[0])
        if (led := said.get(topics.END_EFFECTOR_TARGET.name)) is not None:
            return np.asarray(led.position)
        plan = plan_of(said.get(topics.REFERENCE.name), time)
        return None if plan is None else plan[0]


def posture_of(said: dict[str, Any], body: str, joints: str) -> Posture | None:
    """The posture by two topics; None before both have said something."""
    if body not in said or joints not in said:
        return None
    return Posture(said[body].position, said[body].quaternion, said[joints].position)


def thrusts_of(said: dict[str, Any]) -> Thrusts | None:
    """What the thrusters give, or are asked for where the plant does not say."""
    applied, asked = said.get(topics.APPLIED_THRUST.name), said.get(topics.ALLOCATION.name)
    if applied is None and asked is None:
        return None
    thrust = (asked if applied is None else applied).thrust  # type: ignore[union-attr]
    saturated = np.zeros(len(thrust), dtype=bool) if asked is None else asked.saturated
    return Thrusts(thrust, saturated, np.zeros(len(thrust)))


def forces_of(said: dict[str, Any]) -> Forces | None:
    """The parts of the disturbance: true where the plant says, else observed."""
    observed = said.get(topics.DISTURBANCE_BUDGET.name)
    budget = said.get(topics.TRUE_DISTURBANCE.name, observed)
    if budget is None:
        return None
    return Forces(budget.restoring[:3], budget.coupling[:3], budget.external[:3])


def plan_of(reference: Reference | None, time: float) -> Array | None:
    """Where the tool is to be from now on, (k, 3) m; None where no plan covers the time."""
    if reference is None:
        return None
    after = time - reference.stamp / NANOSECONDS
    if after > reference.times[-1]:
        return None
    points = reference.end_effector
    now = [np.interp(after, reference.times, column) for column in points.T]
    return np.vstack([now, points[reference.times > after]])
