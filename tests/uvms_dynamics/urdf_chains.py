"""Vehicles whose joints are placed as URDF places them."""

import numpy as np

from uvms_core.description.urdf import matrix_to_rpy
from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data
from uvms_core.vehicle.frames import IDENTITY, compose, distal_pose, mounting_pose
from uvms_dynamics.kernels.rotations import skew


def real_vehicle(**overrides) -> Vehicle:
    """The BlueROV2 with its arm."""
    return load_vehicle("bluerov2_alpha5", overrides)


def as_urdf(vehicle: Vehicle) -> Vehicle:
    """The same vehicle with every joint and link in proximal frames."""
    data = vehicle.model_dump(mode="json")
    arm, before = data["arm"], IDENTITY
    for joint, link, place in zip(vehicle.arm.joints, arm["links"], arm["joints"], strict=True):
        place.update(origin=mounting(before), a_m=None, alpha_deg=None, d_m=None)
        before = distal_pose(joint)
        move(link, *before)
    arm["tool"] = mounting(compose(before, mounting_pose(vehicle.arm.tool)))
    return vehicle_from_data(data)


def mounting(pose) -> dict:
    return {
        "position_m": pose[0].tolist(),
        "rpy_deg": np.degrees(matrix_to_rpy(pose[1])).tolist(),
    }


def move(link: dict, position, rotation) -> None:
    """A link's quantities from its frame at a pose to the outer frame."""
    for centre in ("cg_m", "cb_m"):
        link[centre] = (position + rotation @ link[centre]).tolist()
    link["inertia_kg_m2"] = (rotation @ link["inertia_kg_m2"] @ rotation.T).tolist()
    back = np.kron(np.eye(2), rotation.T)
    back[:3, 3:] = -rotation.T @ skew(position)
    added = back.T @ link["added_mass"] @ back
    link["added_mass"] = (0.5 * (added + added.T)).tolist()
    for cylinder in link["drag"]:
        cylinder["center_m"] = (position + rotation @ cylinder["center_m"]).tolist()
        cylinder["axis"] = (rotation @ cylinder["axis"]).tolist()
    link["cylinder"] = None
