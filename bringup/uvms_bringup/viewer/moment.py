"""What is known about a vehicle at one moment, whoever says it: a log or a running graph."""

from dataclasses import dataclass

import numpy as np

from uvms_core.rotations import quat_to_matrix
from uvms_core.signals import Array
from uvms_core.vehicle.frames import Pose, arm_frames, compose, mounting_pose
from uvms_core.vehicle.vehicle import Vehicle


@dataclass(frozen=True)
class Posture:
    """Pose of the body in map_ned, and the joints."""

    position: Array  # (3,) m
    quaternion: Array  # (4,) body to map_ned
    q: Array  # (n,) rad

    @property
    def pose(self) -> Pose:
        """Position and rotation matrix."""
        return self.position, quat_to_matrix(self.quaternion)


@dataclass(frozen=True)
class Thrusts:
    """What the thrusters give."""

    thrust: Array  # (m,) N
    saturated: np.ndarray  # (m,) bool
    turned: Array  # (m,) rad, by how much the propellers have turned, for the eye alone


@dataclass(frozen=True)
class Forces:
    """What else pushes the body, (3,) N each, body frame."""

    restoring: Array
    coupling: Array
    external: Array


@dataclass(frozen=True)
class Moment:
    """Everything that the scene shows at a time; None: nobody says."""

    time: float  # s
    true: Posture | None = None
    estimated: Posture | None = None
    covariance: Array | None = None  # (6, 6) of the estimated pose, axes of map_ned
    thrusts: Thrusts | None = None
    forces: Forces | None = None
    plan: Array | None = None  # (k, 3) m, where the tool is to go next
    target: Array | None = None  # (3,) m, where the tool should be now
    trail: Array | None = (
        None  # (k, 3) m, the way of the tool up to now, where it is not known whole
    )
    current: Array | None = None  # (3,) m/s, of the water


def tool_pose(vehicle: Vehicle, posture: Posture) -> Pose:
    """The tool in map_ned."""
    in_body = compose(arm_frames(vehicle.arm, posture.q)[-1], mounting_pose(vehicle.arm.tool))
    return compose(posture.pose, in_body)
