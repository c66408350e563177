"""The arm's torque law: S-surface feedback per joint with the arm's model as Delta-u, eq. (19)."""

from typing import NamedTuple

import numpy as np

from uvms_control.arm_gains import ArmGains
from uvms_control.errors import ControlSetupError
from uvms_core.signals import Array
from uvms_dynamics import Model, inverse_dynamics
from uvms_dynamics.joint_filter import JointDrive
from uvms_dynamics.kernels import layout
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel


class JointAim(NamedTuple):
    """Where the joints are to be, (n,) each."""

    angle: Array  # rad
    rate: Array  # rad/s
    acceleration: Array  # rad/s^2


class ArmController:
    """tau = K (u + Delta-u), K = A S(q): gains mean bandwidth, whatever the joint carries.

    S(q) is the joint-space inertia of the arm on the floating vehicle, `floating_inertia`; Delta-u
    is the torque that the model needs for the reference's acceleration, friction at the rate that
    the law steers to, less the load that the joint observer has found.

    Args:
        effort_limit: (n,) N m, the drives' greatest torques.
        amplitude: largest acceleration of the feedback, rad/s^2.
        friction_share: share of the modelled friction that is compensated.
    """

    def __init__(self, effort_limit: Array, amplitude: float, friction_share: float) -> None:
        self.effort_limit = np.array(effort_limit, dtype=np.float64)
        if not (self.effort_limit > 0.0).all():
            raise ControlSetupError(
                f"arm effort limits: {self.effort_limit} N m, expected positive numbers"
            )
        self._amplitude, self._friction_share = amplitude, friction_share
        self.gains: ArmGains
        """Stiffness and damping of the feedback; set before the first step."""

    def step(
        self,
        model: Model,
        motion: tuple[Array, Array, Array],
        mass: Array,
        joints: Array,
        aim: JointAim,
    ) -> tuple[Array, JointDrive]:
        """Joint torques (n,) N m within the drives' limits, and what they should bring about.

        No torque presses a joint further into an end stop than the model and the load need to
        hold it there, and an aim beyond a stop is moved to the stop.

        Args:
            model: kernel tables, with the payload where one is known.
            motion: attitude (4,), nu (6,) and reference nu_dot (6,) of the vehicle.
            mass: M(q) (6 + n, 6 + n).
            joints: angles, rates and unknown loads (3, n).
            aim: where the joints are to be.
        """
        effort, acceleration, steered, inertia, inverse = _torque(
            model,
            motion,
            mass,
            joints,
            tuple(aim),
            self.gains.stiffness,
            self.gains.damping,
            self._amplitude,
            self._friction_share,
            self.effort_limit,
        )
        return effort, JointDrive(acceleration, joints[2].copy(), steered, inertia, inverse)


@exact_kernel
def _torque(
    model: Array,
    motion: tuple,
    mass: Array,
    joints: Array,
    aim: tuple,
    stiffness: Array,
    damping: Array,
    amplitude: float,
    friction_share: float,
    effort_limit: Array,
) -> tuple:
    n = stiffness.shape[0]
    q, q_dot, load = joints[0].copy(), joints[1].copy(), joints[2]
    angle, rate, acceleration = _within_stops(model, aim)
    inertia = _floating(mass, n)
    inverse = np.linalg.inv(inertia)
    quaternion, nu, nu_dot = motion
    needed = inverse_dynamics(model, quaternion, nu, nu_dot, q, q_dot, acceleration)
    feedback, steered, left = np.empty(n), np.empty(n), np.empty(n)
    hold, wanted, effort = np.empty(n), np.empty(n), np.empty(n)
    for i in range(n):
        error, slip = angle[i] - q[i], rate[i] - q_dot[i]
        pull = stiffness[i] * error + damping[i] * slip
        feedback[i] = amplitude * np.tanh(pull / amplitude)
        steered[i] = rate[i] + stiffness[i] / damping[i] * error
        friction = _friction(model, i, steered[i])
        left[i] = (1.0 - friction_share) * friction
        hold[i] = needed[6 + i] + friction_share * friction - load[i]
    for i in range(n):
        wanted[i] = hold[i]
        for j in range(n):
            wanted[i] += inertia[i, j] * feedback[j]
        torque = wanted[i]
        if q[i] >= model[i + 1, layout.UPPER]:
            torque = min(torque, hold[i])
        elif q[i] <= model[i + 1, layout.LOWER]:
            torque = max(torque, hold[i])
        effort[i] = min(max(torque, -effort_limit[i]), effort_limit[i])
    for i in range(n):
        acceleration[i] += feedback[i]
        for j in range(n):
            acceleration[i] += inverse[i, j] * (effort[j] - wanted[j] - left[j])
    return effort, acceleration, steered, inertia, inverse


@exact_inner
def _within_stops(model: Array, aim: tuple) -> tuple:
    """The aim with every angle at the end stop where it is beyond, and then no motion outwards."""
    angle, rate, acceleration = aim[0].copy(), aim[1].copy(), aim[2].copy()
    for i in range(angle.shape[0]):
        lower, upper = model[i + 1, layout.LOWER], model[i + 1, layout.UPPER]
        if angle[i] > upper:
            angle[i] = upper
            rate[i], acceleration[i] = min(rate[i], 0.0), min(acceleration[i], 0.0)
        elif angle[i] < lower:
            angle[i] = lower
            rate[i], acceleration[i] = max(rate[i], 0.0), max(acceleration[i], 0.0)
    return angle, rate, acceleration


@exact_inner
def _friction(model: Array, i: int, rate: float) -> float:
    """Torque that the friction of joint i takes at a rate, N m."""
    row = model[i + 1]
    coulomb = row[layout.COULOMB] * np.tanh(rate * row[layout.INVERSE_WIDTH])
    return row[layout.VISCOUS] * rate + coulomb


@exact_inner
def _floating(mass: Array, n: int) -> Array:
    """S = M_qq - M_qb M_bb^-1 M_bq (n, n), as `arm_gains.floating_inertia`."""
    coupling = mass[:6, 6:].copy()
    return mass[6:, 6:] - coupling.T @ np.linalg.solve(mass[:6, :6].copy(), coupling)
