"""Shapes of a vehicle and of what stands around it, and how clear they are of one another."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from uvms_core.scene import SEABED, Obstacle
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_core.vehicle.outline import (
    BoxOutline,
    CapsuleOutline,
    Outline,
    SpheroidOutline,
    box_outline,
    hull_outlines,
    link_outlines,
)
from uvms_dynamics.kernels import clearance as kernels
from uvms_dynamics.model import Model, build_model
from uvms_dynamics.model.vehicle_table import body_poses

HULL_NAME = "hull"
OWN = ("hull", "arm")
"""Kinds of pairs that the posture alone decides on: a link from the hull, or from another link."""
AROUND = ("obstacle", "seabed")
"""Kinds of pairs with what stands around the vehicle."""


class Pair(NamedTuple):
    """Two bodies that must not touch."""

    body: str
    """A link or the hull."""
    other: str
    """The hull, another link, an obstacle or the seabed."""
    kind: str
    """What the other one is: `hull`, `arm`, `obstacle` or `seabed`."""

    def __str__(self) -> str:
        return f"{self.body} and {self.other}"


@dataclass(frozen=True)
class Geometry:
    """What clearances are computed from; model and shapes are what kernels take."""

    model: Model
    shapes: Array  # see `kernels.clearance`
    pairs: tuple[Pair, ...]  # (k,), in the order of the clearances


def build_geometry(vehicle: Vehicle, obstacles: Sequence[Obstacle] = ()) -> Geometry:
    """Shapes of a vehicle, of its seabed if it has one, and of obstacles.

    Pairs that touch in every posture do not count: the hull and the first link, which is mounted
    on it, two links that share a joint, and others that never come apart.
    """
    model = build_model(vehicle)
    hull = [_part_row(each) for each in hull_outlines(vehicle.hull)]
    capsules = _link_rows(vehicle)
    scene = _scene_rows(vehicle, obstacles)
    bodies = _separable(vehicle, model, hull, capsules)
    shapes = _table(hull, capsules, list(scene.values()), bodies)
    return Geometry(model, shapes, _pairs(vehicle, bodies, list(scene)))


def clearances(geometry: Geometry, configuration: Array) -> Array:
    """Signed distance of each pair (k,), m, in the configuration c (m,) of a level vehicle.

    c = (x, y, z, psi, q): position in map_ned, m, yaw and joint angles, rad. Below 0 they overlap.
    """
    return kernels.clearances_of(geometry.model, geometry.shapes, _plain(configuration))


def clearances_along(geometry: Geometry, configurations: Array) -> Array:
    """Clearances (N, k), m, in the configurations (N, m)."""
    return kernels.clearances_along(geometry.model, geometry.shapes, _plain(configurations))


def clearances_of_poses(
    geometry: Geometry, positions: Array, quaternions: Array, angles: Array
) -> Array:
    """Clearances (N, k), m, at any attitude: positions (N, 3), quaternions (N, 4), q (N, n)."""
    poses = map(_plain, (positions, quaternions, angles))
    return kernels.clearances_of_poses(geometry.model, geometry.shapes, *poses)


def _plain(values: Array) -> Array:
    """Contiguous: the kernels would be compiled anew for any other order."""
    return np.ascontiguousarray(values, dtype=float)


def _row() -> Array:
    return np.zeros(kernels.SHAPE_COLUMNS)


def _capsule_row(capsule: CapsuleOutline, body: int = 0) -> Array:
    row = _row()
    is_ball = bool((capsule.start == capsule.end).all())
    row[kernels.KIND] = kernels.BALL if is_ball else kernels.CAPSULE
    row[kernels.BODY] = body
    row[kernels.START : kernels.START + 3] = capsule.start
    row[kernels.DIRECTION : kernels.DIRECTION + 3] = capsule.end - capsule.start
    row[kernels.RADIUS] = capsule.radius
    return row


def _box_row(box: BoxOutline) -> Array:
    row = _row()
    row[kernels.KIND] = kernels.BOX
    row[kernels.START : kernels.START + 3] = box.centre
    row[kernels.HALF : kernels.HALF + 3] = box.half
    row[kernels.ROTATION : kernels.ROTATION + 9] = box.rotation.ravel()
    return row


def _part_row(part: Outline) -> Array:
    """A part of the hull."""
    if isinstance(part, CapsuleOutline):
        return _capsule_row(part)
    if isinstance(part, BoxOutline):
        return _box_row(part)
    return _spheroid_row(part)


def _spheroid_row(spheroid: SpheroidOutline) -> Array:
    row = _row()
    row[kernels.KIND] = kernels.SPHEROID
    row[kernels.HALF : kernels.HALF + 2] = spheroid.along, spheroid.across
    return row


def _link_rows(vehicle: Vehicle) -> list[Array]:
    """Capsules of all links in the frames of the kernels."""
    rows = []
    for number, (position, rotation) in enumerate(body_poses(vehicle.arm)[1:]):
        for each in link_outlines(vehicle.arm, number):
            start, end = position + rotation @ each.start, position + rotation @ each.end
            rows.append(_capsule_row(CapsuleOutline(start, end, each.radius), number + 1))
    return rows


def _scene_rows(vehicle: Vehicle, obstacles: Sequence[Obstacle]) -> dict[str, Array]:
    """Obstacles and seabed, by name."""
    rows = {each.name: _obstacle_row(each) for each in obstacles}
    if (depth := vehicle.environment.seabed_depth_m) is not None:
        row = rows[SEABED] = _row()
        row[kernels.KIND] = kernels.PLANE
        row[kernels.START : kernels.START + 3] = 0.0, 0.0, depth
        row[kernels.HALF : kernels.HALF + 3] = 0.0, 0.0, 1.0
    return rows


def _obstacle_row(obstacle: Obstacle) -> Array:
    if obstacle.box is not None:
        return _box_row(box_outline(obstacle.box))
    assert obstacle.sphere is not None  # what the model checks
    row = _row()
    row[kernels.KIND] = kernels.BALL
    row[kernels.START : kernels.START + 3] = obstacle.sphere.center_m
    row[kernels.RADIUS] = obstacle.sphere.radius_m
    return row


def _table(
    hull: list[Array], capsules: list[Array], scene: list[Array], bodies: list[tuple[int, int]]
) -> Array:
    """All rows; `bodies` are the pairs."""
    head = _row()
    head[: kernels.PAIRS + 1] = len(hull), len(capsules), len(scene), len(bodies)
    pairs = [_row() for _ in bodies]
    for row, pair in zip(pairs, bodies, strict=True):
        row[[kernels.FIRST_BODY, kernels.SECOND_BODY]] = pair
    return np.ascontiguousarray(np.vstack([head, *hull, *capsules, *scene, *pairs]))


_POSTURES = 256
"""So many spread over all joints tell whether two bodies ever come apart."""


def _separable(
    vehicle: Vehicle, model: Model, hull: list[Array], capsules: list[Array]
) -> list[tuple[int, int]]:
    """Pairs of bodies (hull: 0) that are apart in some posture, without neighbours."""
    n = vehicle.n_joints
    candidates = [(i, j) for i in range(n + 1) for j in range(i + 2, n + 1)]
    if not candidates:
        return []
    shapes = _table(hull, capsules, [], candidates)
    configurations = np.zeros((_POSTURES, 4 + n))
    configurations[:, 4:] = _spread_postures(*joint_limits(vehicle))
    greatest = kernels.clearances_along(model, shapes, configurations).max(axis=0)
    return [pair for pair, gap in zip(candidates, greatest, strict=True) if gap > 0.0]


def _spread_postures(lower: Array, upper: Array) -> Array:
    """Joint angles (N, n) that fill the box of their limits evenly, rad.

    The additive recurrence of the powers of 1 / g, g^(n + 1) = g + 1 (Roberts 2018, R_d sequence).
    """
    n = len(lower)
    g = 2.0
    for _ in range(60):
        g = (1.0 + g) ** (1.0 / (n + 1))
    steps = g ** -np.arange(1.0, n + 1.0)
    parts = np.modf(0.5 + np.arange(_POSTURES)[:, None] * steps)[0]
    return lower + (upper - lower) * parts


def _pairs(vehicle: Vehicle, bodies: list[tuple[int, int]], scene: list[str]) -> tuple[Pair, ...]:
    names = [HULL_NAME, *(link.name for link in vehicle.arm.links)]
    own = [Pair(names[j], names[i], "hull" if i == 0 else "arm") for i, j in bodies]
    around = [
        Pair(body, other, "seabed" if other == SEABED else "obstacle")
        for other in scene
        for body in names
    ]
    return (*own, *around)
