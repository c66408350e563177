"""A payload in the tool: the model with it, and the forces that it exerts.

A payload is a point mass here: virtual mass m (with the water that it carries along), weight in
water w, at p in the tool frame. Its own inertia about p is left out: of a sphere of a litre that is
2 parts in a thousand of what its mass has at a lever of 0.5 m.

Its forces are linear in theta = (w, w p, m, m p), but for its moments of inertia about the tool's
origin, m p p^T, which are left out of `payload_forces` too: p is small beside the arm.
"""

import numpy as np

from uvms_core.signals import Array, Payload
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

COLUMNS = 8
"""Of `payload_forces`: w, w p (3), m, m p (3)."""

NOTICEABLE = 0.01
"""Share by which weight or mass may change before a model is made anew."""
NOTICEABLE_SHIFT_M = 0.002
"""Likewise of the position, m."""


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
def payload_forces(model, quat, nu, nu_dot, q, q_dot, q_ddot):
    """Generalized force (6+n, 8) that a payload exerts ON vehicle and joints, by (w, w p, m, m p).

    Body wrench, then joint torques; p in the tool frame. Arguments as in `inverse_dynamics`, in
    water at rest. theta times it is what is unexplained of the motion if the model lacks that
    payload: minus what it adds to `inverse_dynamics`.
    """
    check_quaternion(quat)
    check_motion(nu, nu_dot)
    check_joints(model, q, q_dot, q_ddot)
    n = q.shape[0]
    work, out = make_workspace(model), np.empty((6 + n, 8))
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
    push = _minus_acceleration(v, a, tool, 1.0)
    _carry(model, work, n, pair(down, cross(tool, down)), 0, out)
    _carry(model, work, n, pair(push, cross(tool, push)), 4, out)
    none = (0.0, 0.0, 0.0)
    for k in range(3):
        c = TOOL_ROTATION + k
        axis = model[n + 1, c], model[n + 1, c + 3], model[n + 1, c + 6]
        turning = _minus_acceleration(v, a, axis, 0.0)
        moment = add_vectors(cross(axis, push), cross(tool, turning))
        _carry(model, work, n, pair(none, cross(axis, down)), 1 + k, out)
        _carry(model, work, n, pair(turning, moment), 5 + k, out)
    return out


@kernel
def _minus_acceleration(v, a, place, share):
    """Minus the acceleration of a point of a body; of it, `share` of that of the origin."""
    w = angular(v)
    there = add_vectors(cross(angular(a), place), cross(w, cross(w, place)))
    x, y, z = add_vectors(linear(a), cross(w, linear(v)))
    return -there[0] - share * x, -there[1] - share * y, -there[2] - share * z


@kernel
def _carry(model, work, n, force, column, out):
    """Write what a force on the last link, in its frame, is at the joints and the hull."""
    for i in range(n, 0, -1):
        out[5 + i, column] = force[5]
        force = force_to_parent(model, work, i, force)
    force = into_body(model, force)
    for k in range(6):
        out[k, column] = force[k]


def differs(payload: Payload, other: Payload) -> bool:
    """Whether what is held is so different that a model with it is to be made anew."""
    shift = np.abs(payload.position - other.position).max()
    return bool(
        abs(payload.weight - other.weight) > NOTICEABLE * abs(other.weight)
        or abs(payload.mass - other.mass) > NOTICEABLE * abs(other.mass)
        or shift > NOTICEABLE_SHIFT_M
    )


def _held(payload: Payload | None) -> Payload | None:
    """The payload, if it is confirmed."""
    return payload if payload is not None and payload.held else None


class LoadedModel:
    """The model of a vehicle with what its gripper holds, for whoever works with the model.

    Args:
        bare: table of the vehicle without payload.
    """

    def __init__(self, bare: Model) -> None:
        self._bare = bare
        self._payload: Payload | None = None  # in `model`
        self.model: Model = bare
        """Table with the payload that is held."""

    def would_take(self, payload: Payload | None) -> bool:
        """Whether `take` would make `model` anew."""
        held, known = _held(payload), self._payload
        if held is None or known is None:
            return held is not known
        return differs(held, known)

    def take(self, payload: Payload | None) -> bool:
        """Let `model` have this payload; True where it is made anew.

        It is where the payload is confirmed, let go, or noticeably other than before.
        """
        if not self.would_take(payload):
            return False
        held = _held(payload)
        self._payload = held
        self.model = self._bare
        if held is not None:
            self.model = with_payload(self._bare, held.mass, held.weight, held.position)
        return True
