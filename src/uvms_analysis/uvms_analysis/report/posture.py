"""A vehicle in one posture as shapes for the ray caster."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from uvms_analysis.hull_chord import half_axes, middle, tunnel
from uvms_analysis.report.raycast import Shape
from uvms_core.description.solids import (
    THRUSTER_RADIUS_M,
    Solid,
    link_solids,
)
from uvms_core.description.tree import basis
from uvms_core.scene import Obstacle
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import Pose, arm_frames, compose, joint_frames
from uvms_core.vehicle.outline import box_outline

Colour = tuple[float, float, float]

HULL: Colour = (0.96, 0.74, 0.16)
LINKS: tuple[Colour, Colour] = ((0.90, 0.42, 0.16), (0.66, 0.69, 0.73))
JOINT: Colour = (0.24, 0.26, 0.30)
THRUSTER: Colour = (0.22, 0.24, 0.28)
OBSTACLE: Colour = (0.55, 0.50, 0.44)
JOINT_RADIUS = 1.12
"""Of a joint's ball, in radii of the link that it turns."""


@dataclass(frozen=True)
class Posture:
    """Pose of the body in `map_ned` and joint angles, at a time of the run."""

    time: float  # s
    pose: Pose
    q: Array  # (n,) rad


def rod(start: Array, end: Array, radius: float, colour: Colour, kind: str = "cylinder") -> Shape:
    """A cylinder, or a cone with its tip at the end, between two points."""
    span = end - start
    length = float(np.linalg.norm(span))
    turn = basis(span / length, 2)
    return Shape(kind, (start + end) / 2, turn * [radius, radius, length / 2], colour)


def ball(centre: Array, radius: float, colour: Colour) -> Shape:
    """A sphere."""
    return Shape("sphere", centre, radius * np.eye(3), colour)


def arrow(start: Array, span: Array, radius: float, colour: Colour) -> list[Shape]:
    """An arrow from a point along a vector, its head four radii long."""
    length = float(np.linalg.norm(span))
    neck = start + span * max(0.0, 1.0 - 6.0 * radius / length)
    head = rod(neck, start + span, 2.5 * radius, colour, "cone")
    if length <= 6.0 * radius:  # too short for a shaft
        return [head]
    return [rod(start, neck, radius, colour), head]


def body_shapes(vehicle: Vehicle, posture: Posture) -> list[Shape]:
    """Hull, thrusters and arm in `map_ned`."""
    shapes = [_hull(vehicle, posture.pose), *_thrusters(vehicle, posture.pose)]
    frames = arm_frames(vehicle.arm, posture.q)[1:]
    joints = joint_frames(vehicle.arm, posture.q)
    for number, (link, frame, joint) in enumerate(
        zip(vehicle.arm.links, frames, joints, strict=True)
    ):
        solids = link_solids(link)
        placed = compose(posture.pose, frame)
        shapes += [_solid(solid, placed, LINKS[number % 2]) for solid in solids]
        centre = compose(posture.pose, joint)[0]
        shapes.append(ball(centre, JOINT_RADIUS * min(s.radius for s in solids), JOINT))
    return shapes


def obstacle_shapes(obstacles: Iterable[Obstacle]) -> list[Shape]:
    """Obstacles in `map_ned`."""
    return [_obstacle(each) for each in obstacles]


def _obstacle(obstacle: Obstacle) -> Shape:
    if obstacle.sphere is not None:
        return ball(np.array(obstacle.sphere.center_m), obstacle.sphere.radius_m, OBSTACLE)
    assert obstacle.box is not None  # what the model checks
    box = box_outline(obstacle.box)
    return Shape("box", box.centre, box.rotation * box.half, OBSTACLE)


def _hull(vehicle: Vehicle, pose: Pose) -> Shape:
    """The spheroid itself; without one, the sphere of the hull's volume, as in the URDF."""
    centre = pose[0] + pose[1] @ middle(vehicle.hull)
    return Shape("sphere", centre, pose[1] * half_axes(vehicle.hull), HULL)


def _thrusters(vehicle: Vehicle, pose: Pose) -> list[Shape]:
    """Each as a cylinder along its thrust, through the hull where it lies inside (a tunnel)."""
    shapes = []
    for thruster in vehicle.thrusters:
        along = np.array(thruster.direction)
        first, last = tunnel(vehicle, np.array(thruster.position_m), along)
        ends = [pose[0] + pose[1] @ (np.array(thruster.position_m) + s * along)
                for s in (first, last)]  # fmt: skip
        shapes.append(rod(ends[0], ends[1], THRUSTER_RADIUS_M, THRUSTER))
    return shapes


def _solid(solid: Solid, frame: Pose, colour: Colour) -> Shape:
    centre, turn = compose(frame, solid.pose)
    if solid.length == 0.0:
        return ball(centre, solid.radius, colour)
    return Shape("cylinder", centre, turn * [solid.radius, solid.radius, solid.length / 2], colour)
