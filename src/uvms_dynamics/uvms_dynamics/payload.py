"""A payload in the tool: the model with it, and the forces that it exerts.

A payload is a point mass here: virtual mass m (with the water that it carries along), weight in
water w, at p in the tool frame. Its own inertia about p is left out: of a sphere of a litre that is
2 parts in a thousand of what its mass has at a lever of 0.5 m.

Its forces are linear in (w, w p, m) where p in the mass's column is given:

    F = w down + p x w down (weight)  -  m times the acceleration of the point p (inertia).
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels import layout
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.layout import FIRST, HULL, JOINTS, TOOL_POSITION, TOOL_ROTATION
from uvms_dynamics.kernels.motion import (
    check_joints,
    check_motion,
    check_quaternion,
    down_in_body,
    into_body,
    into_hull,
    link_velocity,
    make_workspace,
    set_angle,
    to_hull,
    velocity_product,
)
from uvms_dynamics.kernels.spatial import (
    add_vectors,
    angular,
    cross,
    force_to_parent,
    linear,
    load3,
    motion_to_child,
    pair,
    spatial_at,
    to_child,
)
from uvms_dynamics.model import Model
from uvms_dynamics.model.vehicle_table import packed

COLUMNS = 5
"""Of `payload_forces`: w, then w p (3), then m."""


def with_payload(model: Model, mass: float, weight: float, position: Array) -> Model:
    """A copy of the model with a point mass in the tool, as a part of the last link.

    Args:
        model: table of the vehicle without payload.
        mass: kg, with the water that it carries along.
        weight: N, in water, positive down.
        position: (3,) m, in the tool frame.
    """
    loaded = model.copy()
    last = int(model[HULL, JOINTS])
    fixtures = model[last + 1]
    rotation = fixtures[TOOL_ROTATION : TOOL_ROTATION + 9].reshape(3, 3)
    place = fixtures[TOOL_POSITION : TOOL_POSITION + 3] + rotation @ position
    row = loaded[last]
    row[layout.NET_WEIGHT] += weight
    row[layout.NET_MOMENT : layout.NET_MOMENT + 3] += weight * place
    row[layout.INERTIA : layout.INERTIA + 21] += packed(_point_mass(mass, place))
    return loaded


def _point_mass(mass: float, place: Array) -> Array:
    """6x6 inertia about the frame's origin: [m 1, -m [r]x; m [r]x, -m [r]x [r]x]."""
    x, y, z = place
    cross_matrix = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    inertia = np.empty((6, 6))
    inertia[:3, :3] = mass * np.eye(3)
    inertia[3:, :3] = mass * cross_matrix
    inertia[:3, 3:] = -inertia[3:, :3]
    inertia[3:, 3:] = -mass * cross_matrix @ cross_matrix
    return inertia


@kernel
def payload_forces(model, quat, nu, nu_dot, q, q_dot, q_ddot, position):
    """Generalized force (6+n, 5) that a payload exerts ON vehicle and joints, by (w, w p, m).

    Body wrench, then joint torques; p in the tool frame. The mass is at `position` (3,), tool
    frame. Arguments as in `inverse_dynamics`, in water at rest. Each column is what is unexplained
    of the motion if the model lacks that payload: minus what it adds to `inverse_dynamics`.
    """
    check_quaternion(quat)
    check_motion(nu, nu_dot)
    check_joints(model, q, q_dot, q_ddot)
    n = q.shape[0]
    work, out = make_workspace(model), np.empty((6 + n, 5))
    down = to_hull(model, down_in_body(quat[0], quat[1], quat[2], quat[3]))
    v, a = into_hull(model, spatial_at(nu, FIRST)), into_hull(model, spatial_at(nu_dot, FIRST))
    for i in range(1, n + 1):
        set_angle(model, work, i, q[i - 1])
        v = link_velocity(model, work, i, v, q_dot[i - 1])
        down = to_child(model, work, i, down)
        a0, a1, a2, b0, b1, b2 = motion_to_child(model, work, i, a)
        x0, x1, y0, y1 = velocity_product(v, q_dot[i - 1])
        a = (a0 + x0, a1 + x1, a2, b0 + y0, b1 + y1, b2 + q_ddot[i - 1])
    tool = load3(model, n + 1, TOOL_POSITION)
    _carry(model, work, n, pair(down, cross(tool, down)), 0, out)
    for k in range(3):
        c = TOOL_ROTATION + k
        axis = model[n + 1, c], model[n + 1, c + 3], model[n + 1, c + 6]
        _carry(model, work, n, pair((0.0, 0.0, 0.0), cross(axis, down)), 1 + k, out)
    x, y, z = position[0], position[1], position[2]
    r = TOOL_ROTATION
    f = model[n + 1]
    place = add_vectors(
        tool,
        (
            f[r] * x + f[r + 1] * y + f[r + 2] * z,
            f[r + 3] * x + f[r + 4] * y + f[r + 5] * z,
            f[r + 6] * x + f[r + 7] * y + f[r + 8] * z,
        ),
    )
    w = angular(v)
    there = add_vectors(linear(v), cross(w, place))
    push = add_vectors(add_vectors(linear(a), cross(angular(a), place)), cross(w, there))
    push = -push[0], -push[1], -push[2]
    _carry(model, work, n, pair(push, cross(place, push)), 4, out)
    return out


@kernel
def _carry(model, work, n, force, column, out):
    """Write what a force on the last link, in its frame, is at the joints and the hull."""
    for i in range(n, 0, -1):
        out[5 + i, column] = force[5]
        force = force_to_parent(model, work, i, force)
    force = into_body(model, force)
    for k in range(6):
        out[k, column] = force[k]
