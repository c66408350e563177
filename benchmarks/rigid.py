"""The dry vehicle in Pinocchio, the reference for rigid dynamics."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin
from motions import Motion

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import distal_pose, mounting_pose

ABA = "pinocchio.aba called from Python, rigid bodies alone"


class Aba:
    """Pinocchio's articulated bodies for several motions, called from Python."""

    def __init__(self, vehicle: Vehicle, motions: Sequence[Motion]) -> None:
        self.model = pinocchio_model(vehicle)
        self.data = self.model.createData()
        self.arguments = [
            (np.concatenate([np.zeros(3), m.quat, m.q]), np.concatenate([m.nu, m.q_dot]), m.tau)
            for m in motions
        ]

    def __call__(self) -> None:
        """All motions once."""
        model, data = self.model, self.data
        for q, v, tau in self.arguments:
            pin.aba(model, data, q, v, tau)

    def results(self) -> Array:
        """Accelerations (k, 6+n) of all motions."""
        return np.array([pin.aba(self.model, self.data, *a) for a in self.arguments])


def pinocchio_model(vehicle: Vehicle) -> pin.Model:
    """A free flyer with the arm on it; the world's z points down."""
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, vehicle.environment.gravity_m_s2])
    parent = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "hull")
    model.appendBodyToJoint(parent, _inertia(vehicle.hull), pin.SE3.Identity())
    placement = _se3(mounting_pose(vehicle.arm.base))
    for joint, link in zip(vehicle.arm.joints, vehicle.arm.links, strict=True):
        offset = pin.SE3(pin.utils.rotate("z", np.radians(joint.offset_deg)), np.zeros(3))
        parent = model.addJoint(parent, pin.JointModelRZ(), placement * offset, joint.name)
        model.appendBodyToJoint(parent, _inertia(link), _se3(distal_pose(joint)))
        placement = _se3(distal_pose(joint))
    model.armature[6:] = [joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints]
    return model


def _inertia(body) -> pin.Inertia:
    return pin.Inertia(body.mass_kg, np.array(body.cg_m), np.array(body.inertia_kg_m2))


def _se3(pose) -> pin.SE3:
    return pin.SE3(pose[1], np.array(pose[0]))
