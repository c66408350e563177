"""The vehicle in MuJoCo: the same rigid chain, with that engine's own model of the water."""

from collections.abc import Sequence
from xml.etree import ElementTree

import mujoco
import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Hull, Link, Vehicle
from uvms_core.vehicle.frames import Pose, distal_pose, mounting_pose
from uvms_dynamics import matrix_to_quat, quat_multiply

FLUIDS = ("inertia_box", "ellipsoid")
"""MuJoCo's two models: a box of the body's inertia (the default), or an ellipsoid."""

_OFF = ("contact", "constraint", "frictionloss", "limit", "equality", "sensor", "actuation")


def mujoco_model(
    vehicle: Vehicle, step_s: float, water: bool = True, fluid: str = "inertia_box"
) -> mujoco.MjModel:
    """Compiled model of a vehicle; without water it is rigid bodies in a vacuum."""
    return mujoco.MjModel.from_xml_string(mjcf(vehicle, step_s, water, fluid))


def mjcf(vehicle: Vehicle, step_s: float, water: bool = True, fluid: str = "inertia_box") -> str:
    """MJCF text: a free joint, then hinges about z; the world's z points down.

    Joint frames are those of the kernels, proximal. Contacts, constraints and whatever else a
    swimming chain does not need are switched off, so that they cost MuJoCo nothing.
    """
    root = ElementTree.Element("mujoco", model=vehicle.name)
    ElementTree.SubElement(
        root, "compiler", angle="radian", inertiafromgeom="false", autolimits="false"
    )
    environment = vehicle.environment
    density = environment.water_density_kg_m3 if water else 0.0
    option = ElementTree.SubElement(
        root, "option", integrator="RK4", timestep=repr(step_s), density=repr(density),
        viscosity=repr(density * environment.kinematic_viscosity_m2_s),
        gravity=_text([0.0, 0.0, environment.gravity_m_s2]),
    )  # fmt: skip
    ElementTree.SubElement(option, "flag", dict.fromkeys(_OFF, "disable"))
    body = ElementTree.SubElement(ElementTree.SubElement(root, "worldbody"), "body", name="hull")
    ElementTree.SubElement(body, "freejoint")
    _add_inertia(body, vehicle.hull, (np.zeros(3), np.eye(3)), fluid)
    place, turn = mounting_pose(vehicle.arm.base)
    for joint, link in zip(vehicle.arm.joints, vehicle.arm.links, strict=True):
        half = 0.5 * np.radians(joint.offset_deg)
        offset = np.array([0.0, 0.0, np.sin(half), np.cos(half)])
        quat = quat_multiply(matrix_to_quat(turn), offset)
        body = ElementTree.SubElement(
            body, "body", name=link.name, pos=_text(place), quat=_text(_scalar_first(quat))
        )
        ElementTree.SubElement(
            body, "joint", type="hinge", axis="0 0 1", armature=repr(joint.rotor_inertia_kg_m2),
            damping=repr(joint.viscous_friction_nm_s if water else 0.0),
        )  # fmt: skip
        place, turn = distal_pose(joint)
        _add_inertia(body, link, (place, turn), fluid)
    return ElementTree.tostring(root, encoding="unicode")


def mujoco_state(quat: Array, nu: Array, q: Array, q_dot: Array) -> tuple[Array, Array]:
    """`qpos` (7+n,) and `qvel` (6+n,) of a motion: MuJoCo's linear velocity is in world axes."""
    turned = _rotation(quat) @ nu[:3]
    return (
        np.concatenate([np.zeros(3), _scalar_first(quat), q]),
        np.concatenate([turned, nu[3:], q_dot]),
    )


def mujoco_acceleration(
    model: mujoco.MjModel, quat: Array, nu: Array, q: Array, q_dot: Array, tau: Array
) -> Array:
    """(nu_dot, q_ddot) (6+n,) under tau (6+n,), in our convention: by components in body axes."""
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = mujoco_state(quat, nu, q, q_dot)
    rotation = _rotation(quat)
    data.qfrc_applied[:] = np.concatenate([rotation @ tau[:3], tau[3:]])
    mujoco.mj_forward(model, data)
    found = data.qacc.copy()
    found[:3] = rotation.T @ found[:3] - np.cross(nu[3:], nu[:3])
    return found


def _add_inertia(body: ElementTree.Element, part: Hull | Link, frame: Pose, fluid: str) -> None:
    """Mass and inertia of a body whose own frame lies at `frame`, and an ellipsoid if asked for."""
    place, turn = frame
    inertia = turn @ np.array(part.inertia_kg_m2) @ turn.T
    moments, axes = np.linalg.eigh(inertia)
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    pose = {
        "pos": _text(place + turn @ np.array(part.cg_m)),
        "quat": _text(_scalar_first(matrix_to_quat(axes))),
    }
    ElementTree.SubElement(
        body, "inertial", pose, mass=repr(part.mass_kg), diaginertia=_text(moments)
    )
    if fluid == "ellipsoid":
        squares = 2.5 * (moments.sum() - 2.0 * moments) / part.mass_kg  # of the half axes
        size = np.sqrt(np.maximum(squares, 1e-4))
        ElementTree.SubElement(
            body, "geom", pose, type="ellipsoid", size=_text(size), mass="0",
            fluidshape="ellipsoid", contype="0", conaffinity="0",
        )  # fmt: skip


def _rotation(quat: Array) -> Array:
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, _scalar_first(quat))
    return matrix.reshape(3, 3)


def _scalar_first(quat: Array) -> Array:
    return np.array([quat[3], quat[0], quat[1], quat[2]])


def _text(values: Sequence[float] | Array) -> str:
    return " ".join(repr(float(value)) for value in values)
