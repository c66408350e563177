"""The hull's swing about an axis that no thruster turns, which the arm must not follow.

Where the thrusters give no moment in pitch, say, the hull is a pendulum under its buoyancy: lightly
damped, and pushed by every acceleration of the arm. An arm that makes up for its swing pushes it in
turn, and later than it should, by the lag of estimate, filter and joints. With R the share of a
correction that the hull takes back and phi the lag, the swing loses 2 zeta w_0 of its damping and
gains R w_0 sin(phi): where that is more, vehicle and arm shake each other for good.

So the arm makes up for where the hull rests, and leaves its swing to the hull. Where it rests the
model says without lag, for the posture that is planned; what the model does not know comes through
a critically damped filter with a quarter of the swing's own frequency,

    F(j w_0) = 1 / (1 + 4 j)^2,     |F| = 1/17,     |Im F| = 8/289 = 0.028,

so that it can take no more than 0.014 R from the damping ratio.
"""

import numpy as np

from uvms_control.controlled_axes import RIGHTED, Flags
from uvms_control.tracking_error import TrackingError
from uvms_core.signals import Array
from uvms_dynamics import Model, restoring_wrench
from uvms_dynamics.kernels.jit import exact_kernel

SLOWER = 4.0
"""The swing's frequency over the filter's bandwidth."""
FIRST, LAST = RIGHTED[0], RIGHTED[-1] + 1


class HullSwing:
    """Parts the tilt of the axes that are left to the hull into rest and swing."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """The hull is taken to be where the model has it at rest."""
        self._state = np.zeros((2, 2))  # what the model does not know of the rest, and its rate

    def step(
        self,
        model: Model,
        motion: tuple[Array, Array],
        mass: Array,
        tracking: TrackingError,
        is_controlled: Flags,
        dt: float,
    ) -> tuple[Array, Array]:
        """The swing's share (6,) of error and rate, body frame; zeros along all other axes.

        Args:
            model: kernel tables, with the payload that is held.
            motion: joints (n,) and rates (n,) that are planned, rad and rad/s.
            mass: M(q) (6 + n, 6 + n).
            tracking: errors against the reference.
            is_controlled: (6,) axes that the thrusters control.
            dt: since the last step, s.
        """
        return _swing(
            model, motion, mass, (tracking.error, tracking.rate), is_controlled, self._state, dt
        )


@exact_kernel
def _swing(
    model: Model,
    motion: tuple,
    mass: Array,
    errors: tuple,
    is_controlled: Flags,
    state: Array,
    dt: float,
) -> tuple[Array, Array]:
    """`HullSwing.step`; `state` is renewed."""
    q, q_dot = motion
    error, rate = np.zeros(6), np.zeros(6)
    rest, stiffness = rest_tilt(model, q)
    later, _ = rest_tilt(model, q + dt * q_dot)
    for k in range(2):
        axis = FIRST + k
        if is_controlled[axis]:
            state[:, k] = 0.0
            continue
        moves = (rest[k] - later[k]) / dt if dt > 0.0 else 0.0  # of the error, which is minus tilt
        w = np.sqrt(max(stiffness, 0.0) / mass[axis, axis]) / SLOWER
        unknown = errors[0][axis] + rest[k]
        decay = np.exp(-w * dt)
        apart = state[0, k] - unknown
        mixed = state[1, k] + w * apart
        state[0, k] = unknown + (apart + mixed * dt) * decay
        state[1, k] = (state[1, k] - w * mixed * dt) * decay
        error[axis] = unknown - state[0, k]
        rate[axis] = errors[1][axis] - moves - state[1, k]
    return error, rate


@exact_kernel
def rest_tilt(model: Model, q: Array) -> tuple[Array, float]:
    """Roll and pitch (2,), rad, in which weight and buoyancy are at rest, each with the other one
    zero, and the stiffness against both at level, N m; zeros where the hull would turn over.
    """
    quaternion = np.zeros(4)
    quaternion[3] = 1.0
    level = restoring_wrench(model, quaternion, q)
    quaternion[0] = quaternion[3] = np.sqrt(0.5)
    metacentric = -restoring_wrench(model, quaternion, q)[3]
    rest = np.zeros(2)
    if metacentric > 0.0:
        rest[0] = np.arctan2(level[3], metacentric)
        rest[1] = np.arctan2(level[4], metacentric)
    return rest, metacentric
