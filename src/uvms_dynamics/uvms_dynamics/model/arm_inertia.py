"""Added inertia of the arm about its joints: the paper's Fig. 6."""

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import Pose, arm_frames


def arm_added_inertia(vehicle: Vehicle, q: Array) -> Array:
    """Added-mass part (n, n) of the arm's joint-space inertia with the vehicle held, kg m^2.

    H_A(q) = sum over the links of J_i^T M_A,i J_i, with M_A,i (6, 6) the added mass of link i about
    its frame's origin and J_i (6, n) from q_dot to that frame's twist in its own axes. Entry (i, i)
    is the inertia about joint i of the water that all links from i to the tool carry, the other
    joints at rest: Fig. 6 shows those of the swing and the shoulder against the elbow angle.
    Neither rigid bodies nor rotors are in it, nor the hull's added mass; axial added mass, the
    swing link's own and the links' added rotational inertia are. q (n,) rad.

    The reference vehicle has, at elbow angles of 0, 45, 90 and 135 degrees and all other joints at
    zero, 2.137, 1.787, 1.122, 0.709 kg m^2 about the swing and 1.678, 1.247, 0.546, 0.328 about the
    shoulder axis.
    """
    angles = np.asarray(q, dtype=float)
    if angles.shape != (vehicle.n_joints,) or not np.isfinite(angles).all():
        raise SignalError(
            f"q: needs {vehicle.n_joints} finite joint angles, has shape {angles.shape}: {q}"
        )
    frames = arm_frames(vehicle.arm, angles)
    inertia = np.zeros((vehicle.n_joints, vehicle.n_joints))
    for i, link in enumerate(vehicle.arm.links):
        J = _link_jacobian(frames, i)
        inertia += J.T @ np.array(link.added_mass) @ J
    return inertia


def _link_jacobian(frames: list[Pose], link: int) -> Array:
    """J (6, n) from q_dot to the twist of a link's frame at its origin, in its own axes."""
    origin, rotation = frames[link + 1]
    J = np.zeros((6, len(frames) - 1))
    for joint, (point, axes) in enumerate(frames[: link + 1]):
        z = axes[:, 2]
        J[:3, joint] = rotation.T @ np.cross(z, origin - point)
        J[3:, joint] = rotation.T @ z
    return J
