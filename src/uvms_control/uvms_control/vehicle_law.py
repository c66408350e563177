"""The vehicle's law: what the hull does well stays on the hull's side.

    tau = M(q) [nu_dot_d + A S(2 D (e_dot + r(e)) / A)] + C(nu_d) nu_d + D(nu_d) nu_d - F_dis

with S of eq. (23). It differs from eq. (22) in three places, each of which made the printed law
worse than no control when the plant is not as its model (docs/control.md has the figures):

- The restoring moment in F_dis is that of the reference attitude. That of the actual attitude,
  eq. (21), cancels the righting moment of the hull, which is roll feedback without lag or noise.
- C and D are evaluated at the velocity of the reference. At the measured velocity over ground they
  are positive feedback in a current: a gust that carries the vehicle along is taken for a motion
  whose drag the thrusters have to overcome.
- The error enters through r(e), the speed at which the vehicle may return: proportional to a small
  error, and by the square root of a large one, so that it can brake with what its thrusters have.

F_dis is that of the instant at which the thrust comes, a thruster lag from now: the arm's motion is
planned, so that its restoring moment is known ahead.
"""

import numpy as np

from uvms_control.controlled_axes import ControlledAxes, Flags
from uvms_control.design.gains import VehicleGains
from uvms_control.reference import ReferenceSample
from uvms_control.tracking_error import TrackingError
from uvms_core.signals import Array, DisturbanceBudget, Odometry
from uvms_dynamics import Model, hull_bias_wrench, restoring_wrench
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat

BRAKING = 0.5
"""Share of the law's greatest acceleration with which the vehicle brakes when it returns."""


class VehicleLaw:
    """Wrench for the vehicle; see the module."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """The law engages anew: its feedback comes up smoothly."""
        self._engaged_s = 0.0

    def step(
        self,
        model: Model,
        axes: ControlledAxes,
        gains: VehicleGains,
        odometry: Odometry,
        mass: Array,
        tracking: TrackingError,
        known: Array,
        dt: float,
    ) -> Array:
        """Wrench (6,) N and N m in the body frame.

        Args:
            model: kernel tables of the vehicle.
            axes: what the thrusters can do at present.
            gains: of the feedback.
            odometry: estimated state.
            mass: (6, 6) vehicle block of M(q).
            tracking: errors, and the reference acceleration at the instant the thrust comes.
            known: (6,) F_dis, what acts ON the vehicle (`at_reference`).
            dt: since the last step, s; 0 at the first.
        """
        self._engaged_s += dt
        share = np.minimum(gains.engaged_share(self._engaged_s), 1.0)
        return law_wrench(
            model,
            axes.is_controlled,
            axes.passing,
            share,
            gains.stiffness,
            gains.damping,
            gains.amplitude(axes.authority, mass),
            odometry.nu,
            mass,
            tracking.error,
            tracking.rate,
            tracking.acceleration,
            known,
        )


@exact_kernel
def law_wrench(
    model: Model,
    is_controlled: Flags,
    passing: Array,
    share: Array,
    stiffness: Array,
    damping: Array,
    amplitude: Array,
    nu: Array,
    mass: Array,
    error: Array,
    rate: Array,
    reference_acceleration: Array,
    known: Array,
) -> Array:
    """The law of the module; all arrays (6,), but `passing` and `mass` (6, 6).

    `share` of the feedback, and not of its gains: of a large error a small share of the gains
    would ask for the whole amplitude as well.
    """
    acceleration = np.zeros(6)
    for i in range(6):
        if is_controlled[i]:
            feedback = _feedback(error[i], rate[i], stiffness[i], damping[i], amplitude[i])
            acceleration[i] = reference_acceleration[i] + share[i] * feedback
    wrench = mass @ acceleration + hull_bias_wrench(model, nu + rate) - known
    return passing @ wrench


@exact_kernel
def _feedback(
    error: float, rate: float, stiffness: float, damping: float, amplitude: float
) -> float:
    """A S(2 D (e_dot + r(e)) / A) of one axis, m/s^2 or rad/s^2; its slopes are P and D."""
    if damping <= 0.0 or amplitude <= 0.0:
        return 0.0
    speed = return_speed(error, stiffness / damping, BRAKING * amplitude)
    return amplitude * np.tanh(damping * (rate + speed) / amplitude)


@exact_kernel
def return_speed(error: float, slope: float, braking: float) -> float:
    """Speed r(e) at which to return: slope e, or what `braking` stops within the distance.

    sqrt(2 b (|e| - b / (2 k^2))) beyond |e| = b / k^2 goes on from k e with the same slope: the
    deceleration along it is b, as far as position controllers of multicopters go (ArduPilot's
    `sqrt_controller`).
    """
    linear = braking / slope**2
    distance = abs(error)
    if distance <= linear:
        return slope * error
    return np.sign(error) * np.sqrt(2.0 * braking * (distance - 0.5 * linear))


def at_reference(
    model: Model,
    total: Array,
    budget: DisturbanceBudget | None,
    odometry: Odometry,
    error: Array,
    is_controlled: Flags,
    q: Array,
    q_ahead: Array,
) -> Array:
    """F_dis (6,) with the restoring moment of the reference attitude and of the arm to come.

    Args:
        model: kernel tables of the vehicle.
        total: (6,) disturbance as the observer gives it, at the actual attitude, eq. (21).
        budget: its parts; an observer without a restoring part gets none.
        odometry: estimated state.
        error: (6,) of position and attitude, body frame. Axes that are not controlled stay as they
            are.
        is_controlled: (6,) axes.
        q: (n,) joints now.
        q_ahead: (n,) where the arm will be when the thrust comes.
    """
    if budget is not None and not budget.restoring.any():
        return total
    turn = np.where(is_controlled[3:], error[3:], 0.0)
    return total + _moved_restoring(model, odometry.quaternion, turn, q, q_ahead)


@exact_kernel
def _moved_restoring(
    model: Model, quaternion: Array, turn: Array, q: Array, q_ahead: Array
) -> Array:
    """Change (6,) of the restoring moment to another attitude and posture; no force."""
    target = quat_multiply(quaternion, rotation_vector_to_quat(turn))
    change = restoring_wrench(model, target, q_ahead) - restoring_wrench(model, quaternion, q)
    change[:3] = 0.0
    return change


def joints_ahead(q: Array, desired: ReferenceSample, ahead: ReferenceSample) -> Array:
    """Joint angles (n,) when the thrust comes: the measured ones, moved as planned."""
    return q + (ahead.q - desired.q)
