"""The arm's law: S-surface feedback per joint with the arm's model as Delta-u, eq. (19)."""

import numpy as np

from uvms_control.arm_config import ArmControlConfig
from uvms_control.errors import ControlSetupError
from uvms_control.s_surface import SSurface
from uvms_core.signals import Array


def sampled_gains(bandwidth: float, damping_ratio: float, dt: float) -> tuple[float, float]:
    """Gains (k in 1/s^2, d in 1/s) that give a sampled double integrator the wanted poles.

    The torque is held over dt, so that e_ddot = -k e - d e_dot with e sampled has the poles of
        z^2 + (k dt^2/2 + d dt - 2) z + (1 + k dt^2/2 - d dt).
    They are put at z = exp(s dt), s the roots of s^2 + 2 zeta w s + w^2: the loop is stable for
    every bandwidth and period, and k -> w^2, d -> 2 zeta w as dt -> 0 (Franklin, Powell and
    Workman, Digital Control of Dynamic Systems, 3rd ed., section 8.1).
    """
    if dt <= 0.0:
        return bandwidth**2, 2.0 * damping_ratio * bandwidth
    spread = bandwidth * np.sqrt(complex(damping_ratio**2 - 1.0))
    first, second = (
        np.exp((-damping_ratio * bandwidth + sign * spread) * dt) for sign in (1.0, -1.0)
    )
    a1, a0 = -(first + second).real, (first * second).real
    return (1.0 + a1 + a0) / dt**2, (3.0 + a1 - a0) / (2.0 * dt)


def floating_inertia(mass: Array) -> Array:
    """Joint-space inertia (n, n) of an arm whose vehicle floats: S = M_qq - M_qb M_bb^-1 M_bq.

    `mass` (6 + n, 6 + n) of the whole system. A joint torque S a with no other change of force
    accelerates the joints by exactly a while the vehicle reacts freely; with M_qq alone the gain of
    a joint that can roll the vehicle would be more than twice the intended one.
    """
    coupling = mass[:6, 6:]
    return mass[6:, 6:] - coupling.T @ np.linalg.solve(mass[:6, :6], coupling)


class ArmController:
    """tau = K (u + Delta-u), K = A S(q): gains mean bandwidth, whatever the joint carries.

    S(q) is the joint-space inertia of the arm on the floating vehicle, `floating_inertia`.
    """

    def __init__(self, config: ArmControlConfig, effort_limit: Array):
        """`effort_limit` (n,): largest joint torques in N m."""
        self.effort_limit = np.array(effort_limit, dtype=np.float64)
        if not (self.effort_limit > 0.0).all():
            raise ControlSetupError(
                f"arm effort limits: {self.effort_limit} N m, expected positive numbers"
            )
        self._config = config
        self._limit = config.integral_limit * self.effort_limit
        self._law: SSurface | None = None  # for the period below, which rarely changes
        self._period = 0.0
        self.reset()

    def reset(self) -> None:
        """Empty the integral."""
        self.integral = np.zeros_like(self.effort_limit)

    def law(self, dt: float) -> SSurface:
        """The S-surface whose slope near zero has the configured bandwidth at the period dt (s)."""
        if self._law is None or dt != self._period:
            self._law, self._period = self._law_for(dt), dt
        return self._law

    def _law_for(self, dt: float) -> SSurface:
        k, d = sampled_gains(self._config.bandwidth, self._config.damping_ratio, dt)
        one, n = self._config.amplitude, self.effort_limit.size
        # With an error scale of A / (2 k) and k_error = 1 the slope A k_error / (2 scale) is k.
        return SSurface(
            k_error=np.ones(n),
            k_rate=np.ones(n),
            error_scale=np.full(n, one / (2.0 * k)),
            rate_scale=np.full(n, one / (2.0 * d)),
            amplitude=np.full(n, one),
        )

    def steered_rate(self, error: Array, q_dot: Array, dt: float) -> Array:
        """Rate (n,) rad/s that the law steers to near zero error: q_dot_d + (k / d) e.

        Friction is compensated at this rate. At the measured one the compensation would feed back
        as negative damping and chatter about zero; at the reference rate alone a joint would stick
        where the feedback torque is smaller than its dry friction.
        """
        law = self.law(dt)
        return q_dot + law.stiffness / law.damping * error

    def effort(
        self, error: Array, rate: Array, inertia: Array, feed_forward: Array, dt: float
    ) -> Array:
        """Joint torques (n,) N m within the limits: K u + feed-forward + integral, eq. (19).

        `error` q_d - q, `rate` of it, `inertia` S(q) (n, n), `feed_forward` (n,) N m: the torque
        that the model needs for the reference acceleration. With the integral it is K Delta-u.
        """
        law = self.law(dt)
        feedback = inertia @ law.acceleration(error, rate)
        growth = self._config.integral_rate * law.stiffness * inertia.diagonal() * error * dt
        wanted = feedback + feed_forward + self.integral
        self._integrate(growth, wanted)
        return np.minimum(np.maximum(wanted, -self.effort_limit), self.effort_limit)

    def _integrate(self, growth: Array, wanted: Array) -> None:
        """Grow the integral within its limit, not further into a saturated torque (anti-windup)."""
        windup = (np.abs(wanted) >= self.effort_limit) & (growth * wanted > 0.0)
        moved = self.integral + growth * ~windup
        self.integral = np.minimum(np.maximum(moved, -self._limit), self._limit)
