"""The body whose added mass is computed: a shape, a mesh file or a part of a vehicle file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Link, Vehicle
from uvms_core.vehicle.frames import Pose
from uvms_dynamics.kernels.rotations import quat_to_matrix, rpy_to_quat
from uvms_dynamics.panel_method.errors import PanelMethodError
from uvms_dynamics.panel_method.files import load_panels
from uvms_dynamics.panel_method.panels import Panels, with_short_edges
from uvms_dynamics.panel_method.solids import Cylinder, Ellipsoid, Solid, parse_solid
from uvms_dynamics.panel_method.theory import in_frame

PANELS = 3000
"""Default number of panels of the finest surface: takes seconds, accurate to some 0.1 %."""

MOST_HALVED = 8000
"""Panels up to which a mesh is refined once more for an error estimate."""

SEA_WATER = 1025.0
"""Default density, kg/m^3."""

FILE_ROW = "vehicle file now"
"""Row with the vehicle file's current values."""


@dataclass(frozen=True)
class Body:
    """One surface in the body frame at several resolutions, coarse to fine, with known values.

    `rows` holds matrices (6, 6) to compare with, by name; nan on the diagonal marks unknown
    terms. `is_mesh`: the panels come from a user's file.
    """

    name: str
    levels: tuple[Panels, ...]
    density: float
    rows: dict[str, Array]
    is_mesh: bool = False


def pose_of(about: Array, rpy_deg: Array) -> Pose:
    """Pose of a file's or shape's frame in the body frame.

    `about` (3,) m is the body origin in the file's frame, rpy_deg the attitude of the file's axes
    seen from the body's: roll, pitch, yaw (ZYX). p_body = R (p_file - about).
    """
    rotation = quat_to_matrix(rpy_to_quat(*np.radians(rpy_deg)))
    return -rotation @ np.asarray(about, dtype=float), rotation


def solid_body(name: str, solid: Solid, pose: Pose, density: float, count: int = PANELS) -> Body:
    """Body of a built-in shape; its finer surface lies closer to the true one."""
    _check_count(count)
    levels = tuple(solid.panels(count // 4, halvings).in_frame(*pose) for halvings in (0, 1))
    exact = solid.closed_form(density)
    rows = {} if exact is None else {solid.theory: _known(in_frame(exact, *pose), solid, pose)}
    return Body(name, levels, density, rows)


def _known(matrix: Array, solid: Solid, pose: Pose) -> Array:
    """The matrix (6, 6) with nan on the diagonal where motion along an open axis contributes."""
    if solid.open_axis:
        along = np.diag(in_frame(np.diag([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), *pose))
        matrix = matrix + np.diag(np.where(along > 1e-12, np.nan, 0.0))
    return matrix


def shape_body(text: str, pose: Pose, density: float, count: int = PANELS) -> Body:
    """Body of a text such as `sphere:0.25`."""
    return solid_body(text, parse_solid(text), pose, density, count)


def mesh_body(
    path: str | Path,
    pose: Pose,
    density: float,
    count: int = PANELS,
    scale: float | None = None,
    flip: bool = False,
) -> Body:
    """Body of a mesh file; its panels are halved, which keeps the surface."""
    _check_count(count)
    panels = with_short_edges(load_panels(path, scale, flip), count // 4).in_frame(*pose)
    halved = 4 * panels.count <= max(count, MOST_HALVED)
    levels = (panels, panels.refined()) if halved else (panels,)
    return Body(str(path), levels, density, {}, is_mesh=True)


def vehicle_body(vehicle: Vehicle, name: str, count: int = PANELS) -> Body:
    """Hull or link of a vehicle with a shape, about the origin of its own frame."""
    density = vehicle.environment.water_density_kg_m3
    parts = {link.name: link for link in vehicle.arm.links if link.cylinder is not None}
    if name == "hull" and (shape := vehicle.hull.spheroid) is not None:
        solid: Solid = Ellipsoid(shape.length_m, shape.diameter_m, shape.diameter_m)
        body = solid_body(name, solid, (np.zeros(3), np.eye(3)), density, count)
        added_mass = vehicle.hull.added_mass
    elif name in parts:
        solid, pose = _link_solid(parts[name])
        body = solid_body(name, solid, pose, density, count)
        added_mass = parts[name].added_mass
    else:
        known = [*(["hull"] if vehicle.hull.spheroid is not None else []), *parts]
        choices = ", ".join(known) or "none"
        raise PanelMethodError(
            f"{name!r}: the vehicle {vehicle.name} has no such part with a shape (hull.spheroid, or"
            f" the cylinder of a link); it has {choices}"
        )
    rows = {**body.rows, FILE_ROW: np.array(added_mass)}
    return Body(name, body.levels, density, rows)


def _link_solid(link: Link) -> tuple[Solid, Pose]:
    """The link's cylinder and the pose of its own frame (axis along x) in the link's."""
    shape = link.cylinder
    assert shape is not None  # only such links are passed
    axis = np.array(shape.axis)
    beside = np.eye(3)[np.abs(axis).argmin()]
    second = np.cross(axis, beside) / np.linalg.norm(np.cross(axis, beside))
    rotation = np.stack([axis, second, np.cross(axis, second)], axis=1)
    return Cylinder(shape.radius_m, shape.length_m), (np.array(shape.center_m), rotation)


def _check_count(count: int) -> None:
    if count < 200:
        raise PanelMethodError(f"{count} panels are too few; at least 200")
