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

from typing import NamedTuple

import numpy as np

from uvms_control.controlled_axes import ControlledAxes, Flags
from uvms_control.design.gains import VehicleGains
from uvms_control.reference import END_EFFECTOR, JOINTS, NU, NU_DOT, POSITION, QUATERNION
from uvms_control.stability import StabilityMonitor, stability_figures
from uvms_control.tracking_error import errors
from uvms_core.signals import Array, Odometry
from uvms_dynamics import Model, hull_bias_wrench, mass_matrix, restoring_wrench
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.products import product
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat

ENGAGES_IN = 2.0
"""The feedback comes up within so many times 1 / bandwidth."""
BRAKING = 0.5
"""Share of the law's greatest acceleration with which the vehicle brakes when it returns."""


class Engaged(NamedTuple):
    """One step of the law, as the arm's share and the log need it."""

    mass: Array  # M(q) (6 + n, 6 + n)
    acceleration: Array  # (6,) of the reference, in the body frame
    wrench: Array  # (6,) N and N m, body frame
    figures: tuple[float, float, float, float]  # of `stability_figures`


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
        monitor: StabilityMonitor,
        odometry: Odometry,
        q: Array,
        rows: tuple[Array, Array],
        acts: tuple[Array, Array, Array, Array],
        dt: float,
    ) -> Engaged:
        """One step.

        Args:
            model: kernel tables of the vehicle with what it holds.
            axes: what the thrusters can do at present.
            gains: of the feedback.
            monitor: of the stability.
            odometry: estimated state.
            q: (n,) joints now.
            rows: of the plan (`PlannedMotion.row`), now and at the instant the thrust comes.
            acts: (6,) each: what acts ON the vehicle at its actual attitude; what of it is fed
                forward; its part by weight and buoyancy, zeros where the
                observer has none; what the thrusters lacked a tick ago, and lack now as well.
            dt: since the last step, s; 0 at the first.
        """
        self._engaged_s += dt
        return Engaged(
            *vehicle_step(
                model,
                (odometry.position, odometry.quaternion, odometry.nu),
                q,
                rows,
                acts,
                (axes.is_controlled, axes.passing, axes.authority),
                (gains.stiffness, gains.damping, gains.authority_share),
                monitor.constants,
                self._engaged_s,
            )
        )


@exact_kernel
def vehicle_step(
    model: Model,
    state: tuple,
    q: Array,
    rows: tuple,
    acts: tuple,
    axes: tuple,
    gains: tuple,
    monitor: tuple,
    engaged_s: float,
) -> tuple:
    """Mass matrix, reference acceleration, wrench and stability; see `VehicleLaw.step`."""
    position, quaternion, nu = state
    planned, ahead = rows
    disturbance, fed, restoring, lacking = acts
    is_controlled, passing, authority = axes
    stiffness, damping, authority_share = gains
    mass = mass_matrix(model, q)
    inertia = mass[:6, :6].copy()
    error, rate, acceleration = errors(
        position,
        quaternion,
        nu,
        planned[POSITION:QUATERNION],
        planned[QUATERNION:NU],
        planned[NU:NU_DOT],
        ahead[NU_DOT:END_EFFECTOR],
    )
    known = fed
    if np.any(fed != 0.0) and np.any(restoring != 0.0):
        n = q.shape[0]
        q_ahead = q + (ahead[JOINTS : JOINTS + n] - planned[JOINTS : JOINTS + n])
        turn = np.where(is_controlled[3:], error[3:], 0.0)
        known = fed + moved_restoring(model, quaternion, turn, q, q_ahead)
    share = np.minimum(engaged_s * np.sqrt(stiffness) / ENGAGES_IN, 1.0)
    amplitude = authority_share * authority / np.diag(inertia)
    wrench = law_wrench(
        model,
        is_controlled,
        passing,
        share,
        stiffness,
        damping,
        amplitude,
        nu,
        inertia,
        error,
        rate,
        acceleration,
        known,
    )
    needed = product(inertia, acceleration) + hull_bias_wrench(model, nu) - disturbance
    weight, epsilon, observed = monitor
    given = wrench - lacking
    figures = stability_figures(error, rate, inertia, needed, given, weight, epsilon, observed)
    return mass, acceleration, wrench, figures


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
    wrench = product(mass, acceleration) + hull_bias_wrench(model, nu + rate) - known
    return product(passing, wrench)


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


@exact_kernel
def moved_restoring(
    model: Model, quaternion: Array, turn: Array, q: Array, q_ahead: Array
) -> Array:
    """Change (6,) of the restoring moment to another attitude and posture; no force.

    turn (3,): rotation vector to that attitude, about the axes that are controlled; the others stay
    as they are. q, q_ahead (n,): joints now, and when the thrust comes.
    """
    target = quat_multiply(quaternion, rotation_vector_to_quat(turn))
    change = restoring_wrench(model, target, q_ahead) - restoring_wrench(model, quaternion, q)
    change[:3] = 0.0
    return change
