"""Gains of the arm by rule: from control period, joint effort over inertia and encoder noise."""

from dataclasses import dataclass

import numpy as np

from uvms_control.arm_config import ArmControlConfig
from uvms_control.vehicle_data import effort_limits
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.plausible.stability import postures
from uvms_dynamics import build_model, mass_matrix
from uvms_dynamics.external_bandwidth import thrust_authority
from uvms_dynamics.joint_prediction import encoder_variances

RADIANS_PER_PERIOD = 0.3
"""Bandwidth times control period: 21 samples in a period of the loop (Franklin, Powell and Workman,
Digital Control of Dynamic Systems, 3rd ed., section 11.1, ask for 20 at least)."""
WHOLE_EFFORT_ERROR_RAD = 0.1
"""Error at which the feedback may ask for the whole effort of a joint; smaller ones must not."""
NOISE_SHARE = 0.01
"""Largest standard deviation of the torque that encoder noise makes, as a share of the effort; and
of the thrust that the other sensors' noise makes, as a share of the authority."""


@dataclass(frozen=True)
class ArmGains:
    """Of the joints' loops at one control period, (n,) each."""

    bandwidth: Array  # rad/s
    stiffness: Array  # k, 1/s^2
    damping: Array  # d, 1/s
    drift: Array  # J: how far an unknown load drifts within a second, rad/s^2
    shake: Array  # density of the acceleration that the hull's jitter makes, rad/s^2 s^(1/2)
    inertia: Array  # S_ii, the largest of the vehicle file's postures, kg m^2
    limited_by: tuple[str, ...]  # what sets the bandwidth: period, effort, noise or config


def arm_gains(vehicle: Vehicle, period_s: float, config: ArmControlConfig) -> ArmGains:
    """Gains of every joint's loop.

    The bandwidth is the least of three: `RADIANS_PER_PERIOD` over the period; that at which an
    error of `WHOLE_EFFORT_ERROR_RAD` takes the whole effort, w^2 S e = tau; and that at which
    encoder noise makes `NOISE_SHARE` of it, S (w^2 s_q + 2 zeta w s_qdot) = share tau. The drift
    of the load follows from the observer's bandwidth, which is the loop's: faster would add noise
    that the loop cannot use.
    """
    inertia, effort = largest_inertia(vehicle), effort_limits(vehicle)
    sigma_q, sigma_rate = np.sqrt(encoder_variances(vehicle))
    bounds = {
        "period": np.full(inertia.size, RADIANS_PER_PERIOD / period_s),
        "effort": np.sqrt(effort / (inertia * WHOLE_EFFORT_ERROR_RAD)),
        "noise": _noise_bound(NOISE_SHARE * effort / inertia, sigma_q, sigma_rate, config),
    }
    if config.bandwidth is not None:
        bounds = {"config": np.full(inertia.size, config.bandwidth)}
    names, values = list(bounds), np.array(list(bounds.values()))
    bandwidth = values.min(axis=0)
    gains = np.array([sampled_gains(w, config.damping_ratio, period_s) for w in bandwidth])
    return ArmGains(
        bandwidth,
        gains[:, 0],
        gains[:, 1],
        load_drift(bandwidth, sigma_q, sigma_rate, period_s),
        hull_jitter(vehicle) * np.sqrt(period_s),
        inertia,
        tuple(names[i] for i in values.argmin(axis=0)),
    )


def _noise_bound(
    acceleration: Array, sigma_q: float, sigma_rate: float, config: ArmControlConfig
) -> Array:
    """Bandwidth (n,) at which w^2 s_q + 2 zeta w s_qdot reaches an acceleration (n,)."""
    half = config.damping_ratio * sigma_rate
    root = np.sqrt(half**2 + sigma_q * acceleration) + half
    return np.asarray(acceleration / max(root.min(), 1e-12))


def load_drift(bandwidth: Array, sigma_q: float, sigma_rate: float, period_s: float) -> Array:
    """Drift J (n,), rad/s^2 within one second, that gives an observer this bandwidth.

    A Kalman filter of angle, rate and a drifting acceleration has the bandwidth (J / s)^(1/3) where
    it reads the angle, and (J / s)^(1/2) where it reads the rate, s being the noise's density
    sigma sqrt(T) (continuous-time solution of the Riccati equation). The better of the two sets it.
    """
    root = np.sqrt(period_s)
    by_angle, by_rate = bandwidth**3 * sigma_q * root, bandwidth**2 * sigma_rate * root
    return np.asarray(np.minimum(by_angle, by_rate))


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


def largest_inertia(vehicle: Vehicle) -> Array:
    """Diagonal of the joint-space inertia (n,), the largest of the file's postures, kg m^2."""
    model = build_model(vehicle)
    found = [floating_inertia(mass_matrix(model, q)) for _, q in postures(vehicle)]
    return np.max(np.diagonal(found, axis1=1, axis2=2), axis=0)


def hull_jitter(vehicle: Vehicle) -> Array:
    """Accelerations of the joints (n,), std in rad/s^2, that noise of the vehicle's loop makes.

    Thrust of `NOISE_SHARE` of each axis's authority, which is what the gains of the vehicle allow
    its sensors' noise, accelerates the hull, and the joints by -M_qq^-1 M_qb nu_dot; the largest of
    the file's postures.
    """
    model, authority = build_model(vehicle), thrust_authority(vehicle)
    found = []
    for _, q in postures(vehicle):
        mass = mass_matrix(model, q)
        hull = NOISE_SHARE * authority / np.diag(mass)[:6]
        found.append(np.hypot.reduce(np.linalg.solve(mass[6:, 6:], mass[6:, :6]) * hull, axis=1))
    return np.asarray(np.max(found, axis=0))


def floating_inertia(mass: Array) -> Array:
    """Joint-space inertia (n, n) of an arm whose vehicle floats: S = M_qq - M_qb M_bb^-1 M_bq.

    `mass` (6 + n, 6 + n) of the whole system. A joint torque S a with no other change of force
    accelerates the joints by exactly a while the vehicle reacts freely; with M_qq alone the gain of
    a joint that can roll the vehicle would be more than twice the intended one.
    """
    coupling = mass[:6, 6:]
    return mass[6:, 6:] - coupling.T @ np.linalg.solve(mass[:6, :6], coupling)
