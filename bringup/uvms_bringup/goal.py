"""The goal of a scenario: a path of the end effector, a motion of the joints, or a pose."""

from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from uvms_bringup.errors import ScenarioError
from uvms_bringup.longest_run import LONGEST_RUN_S
from uvms_bringup.pose_spec import PoseSpec
from uvms_core.config import Config
from uvms_core.errors import ConfigError
from uvms_core.signals import Array, JointGoal, PathGoal, PoseGoal
from uvms_core.signals import Goal as AnyGoal
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_core.vehicle.frames import arm_length
from uvms_core.vehicle.locate import vehicle_path
from uvms_core.vehicle.postures import JointAngles, joint_angles_deg
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import matrix_to_quat, quat_to_rpy, rpy_to_quat
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.plant.config import initial_joints, initial_joints_deg
from uvms_planner import PathSpec


class JointMotionSpec(Config):
    """A motion of the joints alone, from rest to rest between its points."""

    times_s: tuple[Annotated[float, Field(le=LONGEST_RUN_S)], ...] = Field(
        min_length=1, description="time of each point after the start, > 0 and increasing, s"
    )
    positions_deg: tuple[JointAngles, ...] = Field(
        description="joint angles at each point, degrees: a posture of the vehicle file by name,"
        " one value a joint, or values by joint name (other joints stay where they are)"
    )

    @model_validator(mode="after")
    def _is_table(self) -> "JointMotionSpec":
        pairs = zip((0.0, *self.times_s), self.times_s, strict=False)
        if not all(before < after for before, after in pairs):
            raise ValueError(f"times_s must be > 0 and increasing, are {list(self.times_s)}")
        if len(self.positions_deg) != len(self.times_s):
            raise ValueError(
                f"positions_deg has {len(self.positions_deg)} rows for {len(self.times_s)} times"
            )
        return self

    def angles_deg(self, vehicle: Vehicle, start: tuple[float, ...]) -> list[tuple[float, ...]]:
        """Angles (n,) of all joints at each point, degrees, after those at the start (n,).

        Raises:
            ScenarioError: a point does not fit the vehicle; says which, and what the vehicle has.
        """
        points = [start]
        for k, angles in enumerate(self.positions_deg):
            try:
                points.append(joint_angles_deg(vehicle.arm, angles, points[-1]))
            except ConfigError as fault:
                raise ScenarioError(f"goal.joints.positions_deg.{k}: {fault}") from fault
        return points[1:]


class Goal(Config):
    """What the planner is asked for: a path of the end effector, a joint motion, a pose, or
    nothing.
    """

    path: PathSpec | None = Field(None, description="path of the end effector")
    path_made_for: str | None = Field(
        None,
        description="vehicle (name or file) that the path's sizes were chosen for: with another"
        " arm the path is scaled by the ratio of the arms' lengths; none: it is not scaled",
    )
    joints: JointMotionSpec | None = Field(None, description="motion of the joints")
    pose: PoseSpec | None = Field(
        None, description="pose that the vehicle goes to and holds, with its arm as it is"
    )

    @model_validator(mode="after")
    def _one_of_them(self) -> "Goal":
        given = [word for word in ("path", "joints", "pose") if getattr(self, word) is not None]
        if len(given) > 1:
            raise ValueError(f"a goal has one of path, joints and pose; got {' and '.join(given)}")
        if self.path is not None and self.path.absolute and self.path_made_for is not None:
            raise ValueError(
                f"path_made_for: a path in the frame {self.path.frame} is absolute and cannot be"
                " scaled; leave it out"
            )
        return self

    def build(self, vehicle: Vehicle, plant: PlantConfig) -> PathGoal | JointGoal | PoseGoal | None:
        """The goal of a run of this vehicle that starts as `plant` says.

        Raises:
            ScenarioError: the path cannot begin there, or the joint motion does not fit the
                vehicle.
            VehicleFileError: there is no vehicle `path_made_for`.
        """
        own = self.for_vehicle(vehicle, plant)
        if own.path is not None:
            try:
                return own.path.goal(*start_of_end_effector(vehicle, plant))
            except ValueError as fault:
                raise ScenarioError(f"goal.path: {fault}") from fault
        if own.joints is not None:
            positions = np.deg2rad(np.array(own.joints.positions_deg))
            return JointGoal(np.array(own.joints.times_s), positions)
        if own.pose is not None:
            rpy = np.deg2rad(np.array(plant.initial_rpy_deg, dtype=float))
            return own.pose.goal(np.array(plant.initial_position_m, dtype=float), rpy)
        return None

    def for_vehicle(self, vehicle: Vehicle, plant: PlantConfig) -> "Goal":
        """The same goal in numbers for this vehicle: no posture names, and the path scaled."""
        if self.path is not None:
            return Goal(path=self.path.scaled(self._scale(vehicle)))
        if self.joints is not None:
            points = self.joints.angles_deg(vehicle, initial_joints_deg(vehicle, plant))
            return Goal(joints=self.joints.model_copy(update={"positions_deg": tuple(points)}))
        return self

    def _scale(self, vehicle: Vehicle) -> float:
        if self.path_made_for is None:
            return 1.0
        original = load_vehicle(vehicle_path(self.path_made_for))
        return arm_length(vehicle.arm) / arm_length(original.arm)

    @property
    def duration_s(self) -> float:
        """How long the goal takes; of a pose without a time for the way, what it holds."""
        if self.path is not None:
            return self.path.duration_s
        if self.pose is not None:
            return (self.pose.duration_s or 0.0) + self.pose.hold_s
        return self.joints.times_s[-1] if self.joints is not None else 0.0


def start_after(goal: AnyGoal | None, start: PlantConfig) -> PlantConfig:
    """Where a goal leads that begins at `start`: what comes after it begins there.

    After a path the vehicle counts as where it was before: where it ends, only the planner knows.
    """
    if isinstance(goal, PoseGoal):
        yaw = float(np.degrees(quat_to_rpy(goal.quaternion)[2]))
        pose = {"initial_position_m": tuple(goal.position), "initial_rpy_deg": (0.0, 0.0, yaw)}
        return start.model_copy(update=pose)
    if isinstance(goal, JointGoal):
        angles = tuple(np.degrees(goal.positions[-1]).tolist())
        return start.model_copy(update={"initial_joints_deg": angles})
    return start


def start_of_end_effector(vehicle: Vehicle, plant: PlantConfig) -> tuple[Array, Array]:
    """Position (3,) m and quaternion (4,) of the tool in map_ned at the start of a run."""
    position, R_world_tool = end_effector(
        build_model(vehicle),
        np.array(plant.initial_position_m, dtype=float),
        rpy_to_quat(*np.deg2rad(np.array(plant.initial_rpy_deg, dtype=float))),
        initial_joints(vehicle, plant),
    )
    return position, matrix_to_quat(R_world_tool)
