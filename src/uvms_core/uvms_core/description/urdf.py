"""The vehicle file as a URDF, for viewers and for engines that read one.

The root is `base_link_fsd`, forward-starboard-down. URDF knows mass, but neither buoyancy nor added
mass nor rotor inertia: those stay in the vehicle file.
"""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable
from xml.etree.ElementTree import Element, SubElement

import numpy as np

from uvms_core import topics
from uvms_core.description.solids import Solid, hull_solids, link_solids, thruster_solid
from uvms_core.description.tree import HULL_FRAME, Branch, thruster_frame, tree
from uvms_core.signals import Array
from uvms_core.vehicle.arm import Joint, Link
from uvms_core.vehicle.frames import Pose, compose, distal_pose
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.vehicle import Vehicle

COLOURS = {
    "hull": (0.93, 0.69, 0.13, 1.0),
    "arm": (0.55, 0.57, 0.60, 1.0),
    "arm_accent": (0.85, 0.33, 0.10, 1.0),
    "thruster": (0.15, 0.16, 0.18, 1.0),
}
_IDENTITY: Pose = (np.zeros(3), np.eye(3))


def urdf_text(vehicle: Vehicle) -> str:
    """URDF of hull, thrusters, sensors' frames, arm and tool; numbers keep every digit.

    Raises:
        VehicleFileError: as `tree`.
    """
    branches = tree(vehicle)
    robot = Element("robot", name=vehicle.name)
    for name, colour in COLOURS.items():
        material = SubElement(robot, "material", name=name)
        SubElement(material, "color", rgba=_numbers(colour))
    bodies = _bodies(vehicle)
    for frame in (topics.BODY_FRAME, *(branch.frame for branch in branches)):
        robot.append(bodies.get(frame, Element("link", name=frame)))
    robot.extend(_joint(branch) for branch in branches)
    ElementTree.indent(robot)
    return ElementTree.tostring(robot, encoding="unicode", xml_declaration=True) + "\n"


def matrix_to_rpy(R: Array) -> tuple[float, float, float]:
    """Roll, pitch, yaw of R = Rz(yaw) Ry(pitch) Rx(roll), also exact at a pitch of 90 degrees.

    Roll is taken after a rotation by -yaw, so that each makes up for the rounding of the other.
    """
    yaw = math.atan2(R[1, 0], R[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    pitch = math.atan2(-R[2, 0], c * R[0, 0] + s * R[1, 0])
    roll = math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1])
    return roll, pitch, yaw


def _bodies(vehicle: Vehicle) -> dict[str, Element]:
    """The links that have a shape, by frame."""
    bodies = {HULL_FRAME: _body(HULL_FRAME, _IDENTITY, hull_solids(vehicle.hull), "hull")}
    _inertial(bodies[HULL_FRAME], _IDENTITY, vehicle.hull)
    for thruster in vehicle.thrusters:
        frame = thruster_frame(thruster.name)
        bodies[frame] = _body(frame, _IDENTITY, [thruster_solid()], "thruster")
    for number, (joint, link) in enumerate(zip(vehicle.arm.joints, vehicle.arm.links, strict=True)):
        colour = "arm" if number % 2 else "arm_accent"
        bodies[link.name] = _body(link.name, distal_pose(joint), link_solids(link), colour)
        _inertial(bodies[link.name], distal_pose(joint), link)
    return bodies


def _body(name: str, frame: Pose, solids: Iterable[Solid], colour: str) -> Element:
    """A link whose solids are given in a frame of their own."""
    link = Element("link", name=name)
    for solid in solids:
        visual = SubElement(link, "visual")
        _origin(visual, compose(frame, solid.pose))
        geometry = SubElement(visual, "geometry")
        if solid.length:
            size = {"radius": _number(solid.radius), "length": _number(solid.length)}
            SubElement(geometry, "cylinder", size)
        else:
            SubElement(geometry, "sphere", radius=_number(solid.radius))
        SubElement(visual, "material", name=colour)
    return link


def _inertial(link: Element, frame: Pose, body: Hull | Link) -> None:
    """Mass, CG and inertia about it; the inertia's axes are those of the body's own frame."""
    inertial = SubElement(link, "inertial")
    _origin(inertial, compose(frame, (np.array(body.cg_m), np.eye(3))))
    SubElement(inertial, "mass", value=_number(body.mass_kg))
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = body.inertia_kg_m2
    moments = {"ixx": xx, "ixy": xy, "ixz": xz, "iyy": yy, "iyz": yz, "izz": zz}
    SubElement(inertial, "inertia", {name: _number(value) for name, value in moments.items()})


def _joint(branch: Branch) -> Element:
    kind = "fixed" if branch.joint is None else "revolute"
    element = Element("joint", name=branch.joint_name, type=kind)
    SubElement(element, "parent", link=branch.parent)
    SubElement(element, "child", link=branch.frame)
    _origin(element, branch.pose)
    if branch.joint is not None:
        _motion(element, branch.joint)
    return element


def _motion(element: Element, joint: Joint) -> None:
    SubElement(element, "axis", xyz="0 0 1")
    limits = {
        "lower": math.radians(joint.lower_deg),
        "upper": math.radians(joint.upper_deg),
        "effort": joint.effort_limit_nm,
        "velocity": math.radians(joint.rate_limit_deg_s),
    }
    SubElement(element, "limit", {name: _number(value) for name, value in limits.items()})
    friction = {"damping": joint.viscous_friction_nm_s, "friction": joint.coulomb_friction_nm}
    SubElement(element, "dynamics", {name: _number(value) for name, value in friction.items()})


def _origin(element: Element, pose: Pose) -> None:
    SubElement(element, "origin", xyz=_numbers(pose[0]), rpy=_numbers(matrix_to_rpy(pose[1])))


def _numbers(values: Iterable[float]) -> str:
    return " ".join(map(_number, values))


def _number(value: float) -> str:
    return repr(float(value) + 0.0)  # no minus before a zero
