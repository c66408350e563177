"""The external wrench: what acts on the vehicle besides model and thrusters.

A residual of the generalized momentum p = M(q) zeta (De Luca and Mattone 2003),

    r = K [p(t) - p(0) - integral (tau + what the model gives + r) dt], so that  r' = K (F_ext - r):

a first-order estimate of F_ext with bandwidth K, stable for every K > 0, which never differentiates
a signal. In steps of dt, with all states at the middle of the interval, the same sum reads

    r += (1 - exp(-K dt)) (h(zeta, dzeta/dt) - tau - r),

where h is inverse dynamics with the difference quotient as acceleration: M dzeta adds up to p
again, since M at the middle of the step gives dp - dM zeta to second order. Currents, tethers and
wrong parameters all end up in the vehicle's six rows of r; the joints' rows show what acts on the
arm, such as a payload.

White noise of covariance S in zeta makes dp of neighbouring steps noisy by 2 M S M^T, but opposite
in sign, so that with g = 1 - exp(-K dt) the estimate's variance is

    diag(M S M^T) (g / dt)^2 2 / (2 - g),  close to  K^2 diag(M S M^T).
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model, inverse_dynamics, joint_passive_torque, mass_matrix
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.payload import payload_forces

POSE = 4
"""Of a moment (10 + 2 n,): quaternion (4), nu (6), q (n), q_dot (n) in one vector."""
NU = POSE + 6


@exact_kernel
def unexplained_force(
    model: Model,
    dt: float,
    before: Array,
    now: Array,
    thrust: Array,
    effort: Array,
    smooth: tuple[Array, Array],
) -> tuple[Array, Array]:
    """Mean force (6+n,) over the interval beyond model and drives, and a payload's (6+n, 8).

    Args:
        model: without payload.
        dt: length of the interval, s.
        before, now: (10 + 2 n,) moments at its ends.
        thrust: (6,) mean wrench of the thrusters.
        effort: (n,) torques of the drives.
        smooth: vehicle (6,) and joint accelerations (n,) of a filter. In a payload's forces the
            difference quotients would have the same noise as in `force`, and bias its mass.

    Returns:
        What the motion needs beyond thrusters, drives and the joints' friction, and what a payload
        would be of it, as of `payload_forces`.
    """
    n = effort.shape[0]
    quaternion = _mean(_same_sign(before[:POSE], now[:POSE]), now[:POSE])
    quaternion = quaternion / np.sqrt(quaternion.dot(quaternion))
    nu, nu_dot = _mean(before[POSE:NU], now[POSE:NU]), (now[POSE:NU] - before[POSE:NU]) / dt
    q = _mean(before[NU : NU + n], now[NU : NU + n])
    q_dot = _mean(before[NU + n :], now[NU + n :])
    q_ddot = (now[NU + n :] - before[NU + n :]) / dt
    force = inverse_dynamics(model, quaternion, nu, nu_dot, q, q_dot, q_ddot)
    force[:6] -= thrust
    force[6:] -= effort + joint_passive_torque(model, q, q_dot)
    return force, payload_forces(model, quaternion, nu, smooth[0], q, q_dot, smooth[1])


@exact_kernel
def momentum_noise(model: Model, now: Array, twist: Array, rate: float) -> Array:
    """Variances (6+n,) of the momentum, diag M S M^T.

    Args:
        now: (10 + 2 n,) moment.
        twist: (6, 6) covariance of nu.
        rate: variance of the joints' rates, (rad/s)^2.
    """
    n = (now.shape[0] - NU) // 2
    M = mass_matrix(model, now[NU : NU + n])
    variances = np.empty(6 + n)
    for i in range(6 + n):
        total = 0.0
        for j in range(6):
            for k in range(6):
                total += M[i, j] * twist[j, k] * M[i, k]
        for j in range(6, 6 + n):
            total += M[i, j] * rate * M[i, j]
        variances[i] = total
    return variances


@exact_kernel
def follow_external(state: Array, gain: Array, force: Array, forces: Array, theta: Array) -> Array:
    """The external wrench (6,), after its filter has taken in another interval.

    What a payload would be passes the same filter, so that the external wrench is without it from
    the moment on at which the model has it.

    Args:
        state: (6, 9) filtered wrench, and filtered columns of a payload's; changed in place.
        gain: (6,) 1 - exp(-K dt).
        force, forces: (6+n,) and (6+n, 8) as of `unexplained_force`.
        theta: (8,) of the payload that the model has.
    """
    external = np.empty(6)
    for i in range(6):
        state[i, 0] += gain[i] * (force[i] - state[i, 0])
        external[i] = state[i, 0]
        for k in range(8):
            state[i, 1 + k] += gain[i] * (forces[i, k] - state[i, 1 + k])
            external[i] -= state[i, 1 + k] * theta[k]
    return external


@exact_inner
def _mean(a: Array, b: Array) -> Array:
    return 0.5 * (a + b)


@exact_inner
def _same_sign(quaternion: Array, other: Array) -> Array:
    """The quaternion's sign that is nearer to the other's."""
    return quaternion if quaternion.dot(other) >= 0.0 else -quaternion
