"""The tree of the vehicle's frames, from which both URDF and transforms are made.

The frame of a link here is its joint's: origin on the joint's axis, z along it, turning with it, as
URDF requires. The vehicle file's distal Denavit-Hartenberg frame i lies in it
at Tz(d) Tx(a) Rx(alpha), so that the chain is

    T_(i-1)_i = [Tz(d) Tx(a) Rx(alpha)]_(i-1) Rz(offset_i) Rz(q_i),

with the arm's base instead of the first bracket: standard DH, split at the joints. A joint with an
`origin` has that instead of the bracket, as in URDF.
"""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from uvms_core import topics
from uvms_core.errors import VehicleFileError
from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.sensors import mounted_sensors
from uvms_core.signals import Array
from uvms_core.vehicle.arm import Joint
from uvms_core.vehicle.frames import (
    Pose,
    compose,
    distal_pose,
    joint_placements,
    mounting_pose,
)
from uvms_core.vehicle.vehicle import Vehicle
from uvms_core.world_frames import MAP_FRAME

REP103_BODY_FRAME = "base_link"
"""REP-103: forward, port, up; origin as `base_link_fsd`."""
HULL_FRAME = "hull"
"""The hull's body: the root of a URDF should have no mass."""
TOOL_FRAME = "tool"

R_FSD_FLU = np.diag([1.0, -1.0, -1.0])
"""Forward-left-up axes in forward-starboard-down ones (its own inverse)."""


@dataclass(frozen=True)
class Branch:
    """A frame, its parent and its pose there; `joint` then rotates it about its own z."""

    frame: str
    parent: str
    pose: Pose
    joint: Joint | None = None

    @property
    def joint_name(self) -> str:
        """Name of the URDF joint: the arm's own, or made from the frame's."""
        return f"{self.frame}_mount" if self.joint is None else self.joint.name


def tree(vehicle: Vehicle) -> tuple[Branch, ...]:
    """Every frame below `base_link_fsd`, each after its parent.

    Raises:
        VehicleFileError: two frames or two joints would have one name.
    """
    body = topics.BODY_FRAME
    branches = (
        Branch(REP103_BODY_FRAME, body, (np.zeros(3), R_FSD_FLU)),
        Branch(HULL_FRAME, body, (np.zeros(3), np.eye(3))),
        *_sensors(vehicle),
        *_thrusters(vehicle),
        *_arm(vehicle),
    )
    frames = [MAP_FRAME, topics.WORLD_FRAME, body, *(branch.frame for branch in branches)]
    _check_unique(vehicle, "frame", frames)
    _check_unique(vehicle, "joint", [branch.joint_name for branch in branches])
    return branches


def thruster_frame(name: str) -> str:
    """Frame of a thruster; x along its positive thrust."""
    return f"thruster_{name}"


def basis(axis: Array, column: int) -> Array:
    """A rotation (3, 3) with the unit vector `axis` in one column; the others are arbitrary."""
    helper = np.eye(3)[np.argmin(np.abs(axis))]
    second = np.cross(axis, helper)
    second /= np.linalg.norm(second)
    columns = np.array([axis, second, np.cross(axis, second)])
    return np.roll(columns, column, axis=0).T


def _sensors(vehicle: Vehicle) -> Iterator[Branch]:
    for sensor in mounted_sensors(vehicle):
        pose = np.array(sensor.section.position_m), sensor.mounting.to_body
        yield Branch(sensor.mounting_frame, topics.BODY_FRAME, pose)


def _thrusters(vehicle: Vehicle) -> Iterator[Branch]:
    for thruster in vehicle.thrusters:
        pose = np.array(thruster.position_m), basis(np.array(thruster.direction), 0)
        yield Branch(thruster_frame(thruster.name), topics.BODY_FRAME, pose)


def _arm(vehicle: Vehicle) -> Iterator[Branch]:
    arm, parent = vehicle.arm, topics.BODY_FRAME
    for joint, link, pose in zip(arm.joints, arm.links, joint_placements(arm), strict=True):
        offset = quat_to_matrix(rpy_to_quat(0.0, 0.0, np.radians(joint.offset_deg)))
        yield Branch(link.name, parent, compose(pose, (np.zeros(3), offset)), joint)
        parent = link.name
    yield Branch(TOOL_FRAME, parent, compose(distal_pose(arm.joints[-1]), mounting_pose(arm.tool)))


def _check_unique(vehicle: Vehicle, what: str, names: list[str]) -> None:
    twice = sorted(name for name, count in Counter(names).items() if count > 1)
    if twice:
        raise VehicleFileError(
            f"vehicle {vehicle.name}: viewers would see two {what}s named {', '.join(twice)}; "
            f"rename the link, joint or thruster. Taken are {', '.join(sorted(set(names)))}"
        )
