"""The word `goal.pose` of a scenario: a pose that the vehicle goes to and holds."""

import numpy as np
from pydantic import Field, model_validator

from uvms_bringup.longest_run import LONGEST_RUN_S
from uvms_core.config import Config
from uvms_core.signals import Array, PoseGoal
from uvms_core.vehicle.parts import Vector3
from uvms_core.world_frames import R_MAP_MAP_NED
from uvms_dynamics.kernels.rotations import rpy_to_quat
from uvms_planner.path_frame import PathFrame


class PoseSpec(Config):
    """A pose that the vehicle goes to and holds, with its arm as it is."""

    position_m: Vector3 | None = Field(
        None, description="m, of the vehicle's origin in the frame; none: where it starts"
    )
    yaw_deg: float | None = Field(
        None,
        ge=-360.0,
        le=360.0,
        description="deg, heading in the frame: from that of the start, from north to the east"
        " (map_ned), or from east to the north (map); none: as at the start",
    )
    frame: PathFrame = Field(
        "start",
        description="`start`: position from where the vehicle starts, along the axes of map_ned,"
        " and heading from its own there; `map_ned`, absolute, north, east, down; `map`, absolute,"
        " east, north, up",
    )
    duration_s: float | None = Field(
        None,
        gt=0.0,
        le=LONGEST_RUN_S,
        description="s, of the way; none: as short as the limits allow",
    )
    hold_s: float = Field(
        0.0, ge=0.0, le=LONGEST_RUN_S, description="s, to stay there before the goal ends"
    )
    speed_max_m_s: float | None = Field(
        None, gt=0.0, le=100.0, description="m/s, on the way; none: what the limits allow"
    )

    @model_validator(mode="after")
    def _asks_for_something(self) -> "PoseSpec":
        if self.position_m is None and self.yaw_deg is None and not self.hold_s:
            raise ValueError("a pose has position_m, yaw_deg or, to hold the start's, hold_s")
        return self

    def goal(self, position: Array, rpy: Array) -> PoseGoal:
        """The goal of a vehicle that starts at `position` (3,) m with `rpy` (3,) rad, map_ned."""
        yaw = rpy[2]
        if self.yaw_deg is not None:
            yaw = self._yaw_in_map_ned(np.deg2rad(self.yaw_deg), rpy[2])
        return PoseGoal(
            position=self._position_in_map_ned(position),
            quaternion=rpy_to_quat(0.0, 0.0, yaw),
            duration_s=self.duration_s or 0.0,
            hold_s=self.hold_s,
            speed_max_m_s=self.speed_max_m_s or 0.0,
        )

    def _position_in_map_ned(self, start: Array) -> Array:
        if self.position_m is None:
            return np.array(start, dtype=float)
        given = np.array(self.position_m, dtype=float)
        if self.frame == "start":
            return start + given
        return R_MAP_MAP_NED.T @ given if self.frame == "map" else given

    def _yaw_in_map_ned(self, yaw: float, start: float) -> float:
        if self.frame == "start":
            return start + yaw
        return np.pi / 2 - yaw if self.frame == "map" else yaw
