"""Rigid dynamics without water against Pinocchio, an independent engine.

The arms are random but of human size: links of some 0.4 m and 1-5 kg, rotors of 0.01-0.2 kg m^2,
joint rates up to 2 rad/s. At 32 joints their mass matrices have condition numbers of some 1e4, so
the bounds hold without any allowance for it.
"""

from itertools import product

import numpy as np
import pinocchio as pin
import pytest
from random_vehicles import norm_error, random_motion, random_vehicle

from uvms_core.vehicle.frames import distal_pose, mounting_pose
from uvms_dynamics import build_model, end_effector, forward_dynamics, inverse_dynamics, mass_matrix

SIZES = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32]
SEEDS = [11, 12, 13]


def pinocchio_model(vehicle):
    """Free flyer with the arm on it; world z down, so gravity points along +z."""
    model = pin.Model()
    model.gravity.linear = np.array([0.0, 0.0, vehicle.environment.gravity_m_s2])
    parent = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "hull")
    model.appendBodyToJoint(parent, pin_inertia(vehicle.hull), pin.SE3.Identity())
    placement = se3(mounting_pose(vehicle.arm.base))
    for joint, link in zip(vehicle.arm.joints, vehicle.arm.links, strict=True):
        offset = pin.SE3(pin.utils.rotate("z", np.radians(joint.offset_deg)), np.zeros(3))
        parent = model.addJoint(parent, pin.JointModelRZ(), placement * offset, joint.name)
        model.appendBodyToJoint(parent, pin_inertia(link), se3(distal_pose(joint)))
        placement = se3(distal_pose(joint))
    tool = placement * se3(mounting_pose(vehicle.arm.tool))
    model.addFrame(pin.Frame("tool", parent, tool, pin.FrameType.OP_FRAME))
    model.armature[6:] = [joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints]
    return model


def pin_inertia(body):
    return pin.Inertia(body.mass_kg, np.array(body.cg_m), np.array(body.inertia_kg_m2))


def se3(pose):
    return pin.SE3(pose[1], np.array(pose[0]))


@pytest.fixture(params=product(SIZES, SEEDS), ids=lambda case: "{} joints, {}".format(*case))
def dry(request):
    n, seed = request.param
    vehicle = random_vehicle(seed, n, water=False)
    motion = random_motion(np.random.default_rng(seed), n)
    model = pinocchio_model(vehicle)
    q = np.concatenate([[1.0, -2.0, 3.0], motion.quat, motion.q])
    return build_model(vehicle), motion, model, model.createData(), q


def test_inverse_dynamics(dry):
    ours, motion, model, data, q = dry
    velocity = np.concatenate([motion.nu, motion.q_dot])
    acceleration = np.concatenate([motion.nu_dot, motion.q_ddot])
    expected = pin.rnea(model, data, q, velocity, acceleration)
    assert norm_error(inverse_dynamics(ours, *motion), expected) < 1e-10


def test_forward_dynamics(dry):
    ours, motion, model, data, q = dry
    tau = np.linspace(-20.0, 20.0, model.nv)
    expected = pin.aba(model, data, q, np.concatenate([motion.nu, motion.q_dot]), tau)
    found = forward_dynamics(ours, motion.quat, motion.nu, motion.q, motion.q_dot, tau)
    assert norm_error(found, expected) < 1e-10


def test_mass_matrix(dry):
    ours, motion, model, data, q = dry
    upper = np.triu(pin.crba(model, data, q))
    expected = upper + np.triu(upper, 1).T
    assert norm_error(mass_matrix(ours, motion.q), expected) < 1e-10


def test_tool_pose(dry):
    ours, motion, model, data, q = dry
    pin.framesForwardKinematics(model, data, q)
    expected = data.oMf[model.getFrameId("tool")]
    place, rotation = end_effector(ours, q[:3], motion.quat, motion.q)
    np.testing.assert_allclose(place, expected.translation, atol=1e-12)
    np.testing.assert_allclose(rotation, expected.rotation, atol=1e-12)
