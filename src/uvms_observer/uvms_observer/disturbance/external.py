"""The external wrench: what acts on the vehicle besides model and thrusters.

A residual of the generalized momentum p = M(q) zeta (De Luca and Mattone 2003), of which the
vehicle's six rows are kept:

    r = K [p(t) - p(0) - integral (tau + what the model gives + r) dt], so that  r' = K (F_ext - r):

a first-order estimate of F_ext with bandwidth K, stable for every K > 0, which never differentiates
a signal. In steps of dt, with all states at the middle of the interval, the same sum reads

    r += (1 - exp(-K dt)) (h(zeta, dzeta/dt) - tau - r),

where h is inverse dynamics with the difference quotient as acceleration: M dzeta adds up to p
again, since M at the middle of the step gives dp - dM zeta to second order. Currents, payloads,
tethers and wrong parameters all end up in r.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model, inverse_dynamics
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel


class Moment(NamedTuple):
    """Pose and motion of the system at one instant."""

    quaternion: Array  # (4,)
    nu: Array  # (6,)
    q: Array  # (n,)
    q_dot: Array  # (n,)


class ExternalWrenchObserver:
    """Estimate of the external wrench on the vehicle, body frame.

    Args:
        model: kernel tables of the vehicle.
        bandwidth: K, rad/s.
    """

    def __init__(self, model: Model, bandwidth: float) -> None:
        self._model = model
        self._bandwidth = bandwidth
        self.wrench = np.zeros(6)
        self.unexplained = np.zeros(6)
        """Of the last interval alone, unfiltered."""

    def step(self, dt: float, before: Moment, now: Moment, thrust: Array) -> Array:
        """Estimate (6,) after an interval of dt s with this mean thruster wrench (6,)."""
        self.unexplained = unexplained_wrench(self._model, dt, tuple(before), tuple(now), thrust)
        share = -np.expm1(-self._bandwidth * dt)
        self.wrench = self.wrench + share * (self.unexplained - self.wrench)
        return self.wrench


@exact_kernel
def unexplained_wrench(
    model: Model, dt: float, first: tuple[Array, ...], last: tuple[Array, ...], thrust: Array
) -> Array:
    """Mean wrench (6,) over the interval that the motion needs beyond the thrusters' wrench.

    `first` and `last` are the fields of the `Moment`s at its ends: plain tuples, which numba takes
    apart in a fraction of the time.
    """
    before, now = Moment(*first), Moment(*last)
    quaternion = _mean(_same_sign(before.quaternion, now.quaternion), now.quaternion)
    needed = inverse_dynamics(
        model,
        quaternion / np.sqrt(quaternion.dot(quaternion)),
        _mean(before.nu, now.nu),
        (now.nu - before.nu) / dt,
        _mean(before.q, now.q),
        _mean(before.q_dot, now.q_dot),
        (now.q_dot - before.q_dot) / dt,
    )
    return needed[:6] - thrust


@exact_inner
def _mean(a: Array, b: Array) -> Array:
    return 0.5 * (a + b)


@exact_inner
def _same_sign(quaternion: Array, other: Array) -> Array:
    """The quaternion's sign that is nearer to the other's."""
    return quaternion if quaternion.dot(other) >= 0.0 else -quaternion
