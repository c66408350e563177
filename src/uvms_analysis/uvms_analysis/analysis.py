"""A run as its log shows it: truth against estimate, path and reference."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog, Series
from uvms_core import topics
from uvms_core.diagnostics import MANIPULABILITY
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.errors import UvmsError
from uvms_core.signals import Array, PathGoal, Reference, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, build_model, end_effector
from uvms_dynamics.kernels.rotations import quat_to_rpy

ELAPSED = "elapsed_s"
"""Key in the planner's diagnostics: time since the start of its goal, s."""

STATIONARY_M = 1e-6
"""A reference whose end effector moves less than this counts as stationary."""


@dataclass(frozen=True)
class Target:
    """Where the end effector should be, at the times of the true odometry that count."""

    kind: str  # path, reference or start
    index: np.ndarray  # (k,) into the true odometry
    position: Array  # (k, 3) m, map_ned


def at_common_stamps(one: Series, two: Series) -> tuple[Series, Series]:
    """Two series at their common stamps.

    Raises:
        LogError: they have none.
    """
    _, first, second = np.intersect1d(one.stamps, two.stamps, return_indices=True)
    if not len(first):
        raise LogError(f"{one.name} and {two.name} have no stamp in common")
    return one.take(first), two.take(second)


class Analysis:
    """A log and the quantities derived from it, each computed on first use.

    Args:
        log: of the run.
        estimated: take the estimated odometry and the encoders for the truth, where no true ones
            are recorded.
    """

    def __init__(self, log: RunLog, estimated: bool = False) -> None:
        self.log = log
        self.estimated = estimated

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle of the run; LogError where the log's copy is missing or damaged."""
        return self.log.vehicle

    @cached_property
    def _model(self) -> Model:
        try:
            return build_model(self.vehicle)
        except UvmsError as fault:
            raise LogError(f"log {self.log.path}: its vehicle: {fault}") from fault

    @cached_property
    def _true(self) -> tuple[Series, Series]:
        both = (topics.TRUE_ODOMETRY, topics.TRUE_JOINT_STATES)
        if self.estimated:
            both = (topics.ODOMETRY, topics.JOINT_STATES)
        odometry, joints = map(self.log.series, both)
        return at_common_stamps(odometry, joints)

    @property
    def truth(self) -> Series:
        """True odometry."""
        return self._true[0]

    @property
    def joints(self) -> Series:
        """True joints, at the times of the true odometry."""
        return self._true[1]

    @cached_property
    def estimate(self) -> Series:
        """Estimated odometry."""
        return self.log.series(topics.ODOMETRY)

    @cached_property
    def disturbance(self) -> Series:
        """True restoring, coupling and external wrench."""
        return self.log.series(topics.TRUE_DISTURBANCE)

    @cached_property
    def observed(self) -> Series:
        """Observed restoring, coupling and external wrench."""
        return self.log.series(topics.DISTURBANCE_BUDGET)

    @cached_property
    def allocation(self) -> Series:
        """Thrusts, saturation, achieved wrench and residual."""
        return self.log.series(topics.ALLOCATION)

    @cached_property
    def stability(self) -> Series:
        """The controller's Lyapunov function, its rate and both sides of the condition of (29)."""
        if not self.log.has(topics.STABILITY):
            raise LogError(
                f"log {self.log.path}: has no {topics.STABILITY.name}: its controller does not"
                " report it"
            )
        return self.log.series(topics.STABILITY)

    @cached_property
    def rpy_deg(self) -> Array:
        """True roll, pitch and yaw, (k, 3) degrees."""
        return np.rad2deg(np.array([quat_to_rpy(q) for q in self.truth.quaternion]))

    @cached_property
    def end_effector(self) -> Array:
        """True end effector, (k, 3) m in map_ned, at the times of the true odometry."""
        return self._tool(self.truth, self.joints)

    @cached_property
    def estimated_end_effector(self) -> Series:
        """End effector by estimated pose and encoders: `position` (k, 3) m in map_ned."""
        odometry, joints = at_common_stamps(self.estimate, self.log.series(topics.JOINT_STATES))
        columns = {"position": self._tool(odometry, joints)}
        return Series(odometry.stamps, columns, "the estimated end effector")

    def _tool(self, odometry: Series, joints: Series) -> Array:
        if joints.position.shape[1:] != (self.vehicle.n_joints,):
            raise LogError(
                f"log {self.log.path}: its messages have {joints.position.shape[1]} joints, its"
                f" vehicle {self.vehicle.n_joints}"
            )
        rows = zip(odometry.position, odometry.quaternion, joints.position, strict=True)
        return np.array([end_effector(self._model, *row)[0] for row in rows])

    @cached_property
    def references(self) -> list[Reference]:
        """The planner's references."""
        return self.log.signals(topics.REFERENCE) if self.log.has(topics.REFERENCE) else []

    @cached_property
    def planned(self) -> Series | None:
        """The references as one series at their own sample times, None if there are none."""
        if not self.references:
            return None
        names = ("position", "quaternion", "nu", "q", "q_dot", "end_effector")
        return _at_own_times(self.references, self.references, names)

    @cached_property
    def planned_disturbance(self) -> Series:
        """Restoring and coupling wrench that the references expect, at their own sample times.

        Raises:
            LogError: there are no references, or they do not say.
        """
        saying = [each for each in self.references if each.disturbance is not None]
        if not saying:
            raise LogError(
                f"log {self.log.path}: its references do not say what disturbance was planned"
            )
        parts = [each.disturbance for each in saying]
        return _at_own_times(saying, parts, ("restoring", "coupling"))

    @cached_property
    def planned_disturbance_error(self) -> tuple[Array, Array]:
        """Time (k,) and true minus planned restoring plus coupling wrench (k, 6), body frame.

        The first sample is left out, as no torque is applied yet.
        """
        plan, time = self.planned_disturbance, self.disturbance.time
        index = np.flatnonzero((time >= plan.time[0]) & (time <= plan.time[-1]))[1:]
        true = (self.disturbance.restoring + self.disturbance.coupling)[index]
        planned = plan.restoring + plan.coupling
        at = [np.interp(time[index], plan.time, planned[:, i]) for i in range(6)]
        return time[index], true - np.column_stack(at)

    @property
    def path(self) -> PathGoal | None:
        """The path of the run's goal, None without one."""
        return self.log.path_goal

    @cached_property
    def path_start_s(self) -> float:
        """When the path begins: as the planner reports, else where its references fit it best.

        A step that plans ahead of the path reports 0 s, which says nothing of when it begins.
        """
        for status in self.log.statuses(topics.MOTION_PLANNER):
            if to_seconds(status.stamp) <= self._path_asked_s:
                continue
            if (elapsed := status.number(ELAPSED)) > 0.0:
                return round(to_seconds(status.stamp) - elapsed, 9)
        return self._fitted_start()

    @cached_property
    def _path_asked_s(self) -> float:
        """When the planner accepted the path; -1 where nobody says."""
        began = [goal["began_s"] for goal in self._path_goals]
        return float(began[0]) if began and began[0] is not None else -1.0

    @property
    def _path_goals(self) -> list[Mapping[str, Any]]:
        """What the run's end tells of its goals that are paths."""
        end = self.log.end
        return [] if end is None else [goal for goal in end.goals if goal["kind"] == "path"]

    @property
    def _is_before_its_path(self) -> bool:
        """Whether the path is a goal whose turn had not come when the run ended."""
        goals = self._path_goals
        return bool(goals) and all(goal["began_s"] is None for goal in goals)

    def _fitted_start(self) -> float:
        if self.path is None or self.planned is None:
            return 0.0
        curve, time, points = EndEffectorPath(self.path), self.planned.time, self.planned
        starts = np.array([reference.stamp for reference in self.references]) / 1e9
        misfits = [
            float(np.sum((curve.positions(time - start) - points.end_effector) ** 2))
            for start in starts[: max(len(starts) // 4, 4)]
        ]
        return float(starts[int(np.argmin(misfits))])

    @cached_property
    def target(self) -> Target:
        """Where the end effector should be: on its path while that runs; without a path, where
        the planned motion of the joints puts it; without either, where it is at the start.
        """
        time = self.truth.time
        if self.path is not None and not self._is_before_its_path:
            curve = EndEffectorPath(self.path)
            after = time - self.path_start_s
            index = np.flatnonzero((after >= 0.0) & (after <= curve.duration))
            return Target("path", index, curve.positions(after[index]))
        if self.planned is not None and self._moves(self.planned.end_effector):
            plan = self.planned
            index = np.flatnonzero((time >= plan.time[0]) & (time <= plan.time[-1]))
            columns = [np.interp(time[index], plan.time, plan.end_effector[:, i]) for i in range(3)]
            return Target("reference", index, np.column_stack(columns))
        held = np.tile(self.end_effector[:1], (len(time), 1))
        return Target("start", np.arange(len(time)), held)

    @staticmethod
    def _moves(points: Array) -> bool:
        return bool(np.ptp(points, axis=0).max() > STATIONARY_M)

    @cached_property
    def end_effector_error(self) -> Array:
        """True end effector minus target, (k, 3) m."""
        return self.end_effector[self.target.index] - self.target.position

    @cached_property
    def tracking_error(self) -> Array:
        """Estimated end effector minus target, (k, 3) m: the error that the loop itself can see."""
        columns = {"position": self.target.position}
        wanted = Series(self.truth.stamps[self.target.index], columns, f"the {self.target.kind}")
        estimated, wanted = at_common_stamps(self.estimated_end_effector, wanted)
        return estimated.position - wanted.position

    @cached_property
    def navigation(self) -> tuple[Array, Array, Array]:
        """Time (k,), estimated minus true position (k, 3) m, and its standard deviation."""
        estimate, truth = at_common_stamps(self.estimate, self.truth)
        variance = np.diagonal(estimate.pose_covariance, axis1=1, axis2=2)[:, :3]
        error = estimate.position - truth.position
        return truth.time, error, np.sqrt(np.maximum(variance, 0.0))

    @cached_property
    def vehicle_error(self) -> tuple[Array, Array]:
        """Time (k,) and true minus planned position of the vehicle (k, 3) m."""
        plan = self.planned
        if plan is None:
            raise LogError(f"log {self.log.path}: has no reference")
        time = self.truth.time
        index = np.flatnonzero((time >= plan.time[0]) & (time <= plan.time[-1]))
        columns = [np.interp(time[index], plan.time, plan.position[:, i]) for i in range(3)]
        return time[index], self.truth.position[index] - np.column_stack(columns)

    @cached_property
    def joint_error_deg(self) -> tuple[Array, Array]:
        """Time (k,) and true minus planned joint angles (k, n), degrees.

        Raises:
            LogError: there is no reference.
        """
        plan = self.planned
        if plan is None:
            raise LogError(f"log {self.log.path}: has no reference")
        time = self.joints.time
        index = np.flatnonzero((time >= plan.time[0]) & (time <= plan.time[-1]))
        wanted = [np.interp(time[index], plan.time, column) for column in plan.q.T]
        error = self.joints.position[index] - np.column_stack(wanted)
        return time[index], np.rad2deg(error)

    @cached_property
    def planner_step_ms(self) -> Array:
        """Computing time of the planner's steps."""
        values = [status.number("step_ms") for status in self.log.statuses(topics.MOTION_PLANNER)]
        return np.array([value for value in values if np.isfinite(value)])

    @cached_property
    def least_manipulability(self) -> float | None:
        """The arm's least along the planned path, as a share of its best; None without a path."""
        statuses = self.log.statuses(topics.MOTION_PLANNER)
        values = [status.number(MANIPULABILITY) for status in statuses]
        return min((value for value in values if np.isfinite(value)), default=None)

    @cached_property
    def lockstep_timeouts(self) -> int:
        """Number of times the plant continued without a command; LogError where nobody says."""
        values = [status.number("lockstep_timeouts") for status in self.log.statuses(topics.PLANT)]
        if not (finite := [value for value in values if np.isfinite(value)]):
            raise LogError(f"log {self.log.path}: its plant does not report them")
        return int(max(finite))


def _at_own_times(
    references: Sequence[Reference], parts: Sequence[Any], names: Sequence[str]
) -> Series:
    """Fields of the parts, one of each reference, as one series at the references' sample times.

    Segments share their end points: the later one is kept.
    """
    columns = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    stamps = np.concatenate([r.stamp + np.rint(1e9 * r.times).astype(np.int64) for r in references])
    last = len(stamps) - 1 - np.unique(stamps[::-1], return_index=True)[1]
    kept = {name: column[last] for name, column in columns.items()}
    return Series(stamps[last], kept, topics.REFERENCE.name)
