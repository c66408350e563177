"""The paper's recursive Newton-Euler dynamics in plain numpy, for comparison with the kernels.

Written as section 2.2 states it, M_RB nu_dot + C_RB nu + M_A nu_r_dot + C_A nu_r + D nu_r + g,
over ground and with the current as an argument, body by body in the distal DH frames. The kernels
do the same in one moving frame with one inertia per body; tests compare the two.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Joint, Link, Vehicle
from uvms_core.vehicle.frames import (
    Pose,
    arm_frames,
    joint_pose,
    mounting_pose,
    placement_pose,
)
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.numpy_reference import body_forces
from uvms_dynamics.numpy_reference.body_forces import Motion

_Z = np.array([0.0, 0.0, 1.0])
_STILL = np.zeros(3)


def inverse_dynamics(
    vehicle: Vehicle,
    quaternion: Array,
    nu: Array,
    nu_dot: Array,
    q: Array,
    q_dot: Array,
    q_ddot: Array,
    current: Array = _STILL,
) -> Array:
    """Generalized force (6+n,) that makes a motion: body wrench, then joint torques.

    nu (6,) over ground, body frame; nu_dot the derivative of its components; current (3,) of the
    water in the world, m/s, constant and uniform. Section 2.2, eq. (14)-(15).
    """
    motion = hull_motion(quaternion, nu, nu_dot, current)
    reaction, torques = _arm_reaction(vehicle, motion, q, q_dot, q_ddot, weights=True)
    own = body_forces.rigid_body(vehicle.hull, motion)
    own += body_forces.added_mass(vehicle.hull, motion)
    own += body_forces.hull_damping(vehicle.hull, motion.relative()[0], vehicle.environment)
    own -= body_forces.weight_and_buoyancy(vehicle.hull, motion.down, vehicle.environment)
    rotors = [joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints]
    return np.concatenate([own + reaction, torques + np.array(rotors) * q_ddot])


def coupling_wrench(
    vehicle: Vehicle,
    quaternion: Array,
    nu: Array,
    nu_dot: Array,
    q: Array,
    q_dot: Array,
    q_ddot: Array,
    current: Array = _STILL,
) -> Array:
    """Wrench (6,) of the arm ON the vehicle about the body origin, without weight, (14)-(15)."""
    motion = hull_motion(quaternion, nu, nu_dot, current)
    return -_arm_reaction(vehicle, motion, q, q_dot, q_ddot, weights=False)[0]


def restoring_wrench(vehicle: Vehicle, quaternion: Array, q: Array) -> Array:
    """Weight and buoyancy (6,) of hull and links ON the system, body frame, eq. (13)."""
    down = quat_to_matrix(quaternion).T @ _Z
    total = body_forces.weight_and_buoyancy(vehicle.hull, down, vehicle.environment)
    frames = arm_frames(vehicle.arm, q)[1:]
    for link, pose in zip(vehicle.arm.links, frames, strict=True):
        in_link = pose[1].T @ down
        own = body_forces.weight_and_buoyancy(link, in_link, vehicle.environment)
        total += to_outer_frame(pose, own)
    return total


def mass_matrix(vehicle: Vehicle, q: Array) -> Array:
    """M(q) (6+n, 6+n), a column for each unit acceleration from rest."""
    n = vehicle.n_joints
    level, rest = np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6)
    at_rest = inverse_dynamics(vehicle, level, rest, rest, q, np.zeros(n), np.zeros(n))
    columns = [
        inverse_dynamics(vehicle, level, rest, unit[:6], q, np.zeros(n), unit[6:]) - at_rest
        for unit in np.eye(6 + n)
    ]
    return np.array(columns).T


def forward_dynamics(
    vehicle: Vehicle,
    quaternion: Array,
    nu: Array,
    q: Array,
    q_dot: Array,
    tau: Array,
    current: Array = _STILL,
) -> Array:
    """Accelerations (6+n,) = (nu_dot, q_ddot) over ground: M(q)^-1 (tau - bias)."""
    n = vehicle.n_joints
    zero = np.zeros(6)
    bias = inverse_dynamics(vehicle, quaternion, nu, zero, q, q_dot, np.zeros(n), current)
    solution = np.linalg.solve(mass_matrix(vehicle, q), tau - bias)
    return np.asarray(solution, dtype=np.float64)


def hull_motion(quaternion: Array, nu: Array, nu_dot: Array, current: Array) -> Motion:
    """Motion of the body frame: the origin's acceleration is v_dot + omega x v."""
    to_body = quat_to_matrix(quaternion).T
    acceleration = nu_dot[:3] + np.cross(nu[3:], nu[:3])
    return Motion(nu[3:], nu_dot[3:], nu[:3], acceleration, to_body @ current, to_body @ _Z)


def _arm_reaction(
    vehicle: Vehicle, hull: Motion, q: Array, q_dot: Array, q_ddot: Array, weights: bool
) -> tuple[Array, Array]:
    """Force (6,) that the arm needs at the body origin, and the torque (n,) about each joint."""
    arm = vehicle.arm
    motions = [_carried(hull, mounting_pose(arm.base))]
    poses = [joint_pose(joint, angle) for joint, angle in zip(arm.joints, q, strict=True)]
    for joint, pose, rate, acceleration in zip(arm.joints, poses, q_dot, q_ddot, strict=True):
        placed = _carried(motions[-1], placement_pose(joint))
        motions.append(next_motion(placed, joint, pose, rate, acceleration))
    force, torques = np.zeros(6), np.zeros(len(poses))
    for i in reversed(range(len(poses))):  # eq. (14)-(15), from the tip to the base
        force = force + _link_force(vehicle, arm.links[i], motions[i + 1], weights)
        force = to_outer_frame(poses[i], force)
        torques[i] = force[5]
        force = to_outer_frame(placement_pose(arm.joints[i]), force)
    return to_outer_frame(mounting_pose(arm.base), force), torques


def next_motion(
    motion: Motion, joint: Joint, pose: Pose, rate: float, acceleration: float
) -> Motion:
    """Motion of frame i+1 from that of its joint, eq. (2)-(7) and the accelerations after them.

    With distal DH frames the offset r turns with link i+1, so omega_(i+1) goes with it: corrected
    from the print of (4)-(5).
    """
    position, rotation = pose
    omega = rotation.T @ (motion.omega + _Z * rate)
    omega_dot = rotation.T @ (
        motion.omega_dot + _Z * acceleration + np.cross(motion.omega, _Z * rate)
    )
    r = rotation.T @ position  # (a, d sin(alpha), d cos(alpha)), constant
    return Motion(
        omega,
        omega_dot,
        rotation.T @ motion.velocity + np.cross(omega, r),
        rotation.T @ motion.acceleration
        + np.cross(omega_dot, r)
        + np.cross(omega, np.cross(omega, r)),
        rotation.T @ motion.current,
        rotation.T @ motion.down,
    )


def _carried(motion: Motion, pose: Pose) -> Motion:
    """Motion of a frame that is fixed at `pose` in a moving one."""
    position, rotation = pose
    omega, omega_dot = motion.omega, motion.omega_dot
    velocity = motion.velocity + np.cross(omega, position)
    acceleration = (
        motion.acceleration
        + np.cross(omega_dot, position)
        + np.cross(omega, np.cross(omega, position))
    )
    turned = (omega, omega_dot, velocity, acceleration, motion.current, motion.down)
    return Motion(*(rotation.T @ vector for vector in turned))


def _link_force(vehicle: Vehicle, link: Link, motion: Motion, weights: bool) -> Array:
    """Force (6,) that a link needs for its own motion, about its frame's origin."""
    nu_r, _ = motion.relative()
    force = body_forces.rigid_body(link, motion) + body_forces.added_mass(link, motion)
    for cylinder in link.drag:
        across, along = vehicle.arm.drag_coefficient, vehicle.arm.friction_coefficient
        force -= body_forces.cylinder_drag(cylinder, across, along, nu_r, vehicle.environment)
    if weights:
        force -= body_forces.weight_and_buoyancy(link, motion.down, vehicle.environment)
    return force


def to_outer_frame(pose: Pose, force: Array) -> Array:
    """Force (6,) of a frame at `pose` about the outer frame's origin: (R f, R n + p x R f)."""
    position, rotation = pose
    turned = rotation @ force[:3]
    return np.concatenate([turned, rotation @ force[3:] + np.cross(position, turned)])
