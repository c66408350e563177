"""Gains of the vehicle's law by rule, from the vehicle file and the control period alone.

Each axis gets the largest bandwidth whose loop keeps its margins (`largest_bandwidth`) with the
arm in any of the postures of the vehicle file: the posture that allows least decides. The gains are
accelerations, and the law multiplies them by M(q): they mean the same whatever the arm does.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from uvms_control.controlled_axes import AXES, ControlledAxes
from uvms_control.design.axis import Axis, AxisGains
from uvms_control.design.bandwidth import AxisDesign, Limits, largest_bandwidth
from uvms_control.design.conditions import require_stable
from uvms_control.design.vehicle_axes import Timing, vehicle_axes
from uvms_control.errors import ControlSetupError
from uvms_control.vehicle_config import GainConfig
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.plausible.stability import postures

ATTITUDE = slice(3, 5)
"""Roll and pitch, along which the arm's weight acts."""


@dataclass(frozen=True)
class VehicleGains:
    """Feedback of the six axes; 0 where an axis is left to the hull.

    Attributes:
        stiffness: (6,) P, acceleration per error, 1/s^2.
        damping: (6,) D, acceleration per rate of the error, 1/s.
        righting: (6,) c / m that the hull adds to the stiffness, 1/s^2.
        observer: (6,) K, bandwidth of the external wrench's estimate that goes with them, rad/s.
        authority_share: of an axis's thrust that the feedback may ask for.
    """

    stiffness: Array
    damping: Array
    righting: Array
    observer: Array
    authority_share: float

    def amplitude(self, authority: Array, mass: Array) -> Array:
        """A (6,): greatest acceleration of the feedback, m/s^2 and rad/s^2."""
        return self.authority_share * authority / np.diag(mass)


def vehicle_gains(vehicle: Vehicle, period: float, config: GainConfig) -> VehicleGains:
    """The gains for a control period in s.

    Raises:
        ControlSetupError: the loop would not be stable with a bandwidth of the configuration, or no
            bandwidth of an axis keeps the margins.
    """
    designs = axis_designs(vehicle, period, config)
    gains = [AxisGains(0.0, 0.0) if each is None else each.gains for each in designs]
    return VehicleGains(
        np.array([each.stiffness for each in gains]),
        np.array([each.damping for each in gains]),
        np.array([0.0 if each is None else max(each.axis.hull_stiffness, 0.0) for each in designs]),
        np.array([each.observer for each in gains]),
        config.authority_share,
    )


def thrust_delay(axes: ControlledAxes, period: float, config: GainConfig) -> float:
    """How long after a tick the thrust of its command comes on average, s, in roll and pitch.

    What the allocator leaves of the lag, and half a period, as the command is held; lag that it
    makes up for is made up for at the end of the period, which is another half.
    """
    share, lag = config.lag_compensation, float(np.max(axes.lag[ATTITUDE]))
    return (1.0 - share) * lag + 0.5 * (1.0 + share) * period


def axis_designs(
    vehicle: Vehicle, period: float, config: GainConfig, angles: Sequence[Array] | None = None
) -> tuple[AxisDesign | None, ...]:
    """The design of each axis, in the posture that allows least; None: left to the hull.

    `angles`: joint angles (n,) rad of the postures; None: all of the vehicle file.
    """
    angles = [q for _, q in postures(vehicle)] if angles is None else angles
    limits = Limits(delay_periods=config.delay_margin_periods, noise_share=config.noise_share)
    timing = Timing(
        period,
        lag_compensated=config.lag_compensation,
        external=config.external_bandwidth_rad_s,
    )
    by_posture = [vehicle_axes(vehicle, q, timing) for q in angles]
    return tuple(
        _least([_design(each, k, limits, config) for each in axes], k)
        for k, axes in enumerate(zip(*by_posture, strict=True))
    )


def _least(designs: list[AxisDesign | None], k: int) -> AxisDesign | None:
    found = [each for each in designs if each is not None]
    if not found:
        return None
    least = min(found, key=lambda each: each.gains.stiffness)
    if least.gains.stiffness <= 0.0:
        raise ControlSetupError(
            f"control.gains: no bandwidth of {AXES[k]} keeps the margins; lower"
            " control.gains.delay_margin_periods, or set control.gains.bandwidth_rad_s"
        )
    return least


def _by_rule(axis: Axis, limits: Limits) -> AxisDesign:
    """The largest bandwidth; where sensors are so poor that there is none, noise may cost more.

    A vehicle that is held by noisy thrusters is better off than one that nobody holds.
    """
    share = limits.noise_share
    while True:
        found = largest_bandwidth(axis, replace(limits, noise_share=share))
        if found.gains.stiffness > 0.0 or share >= 1.0:
            return found
        share = min(2.0 * share, 1.0)


def _design(axis: Axis | None, k: int, limits: Limits, config: GainConfig) -> AxisDesign | None:
    if axis is None:
        return None
    if config.bandwidth_rad_s is None:
        return _by_rule(axis, limits)
    bandwidth = config.bandwidth_rad_s[k]
    ratio = 1.0 if config.damping_ratio is None else config.damping_ratio[k]

    def gains_at(value: float, zeta: float) -> AxisGains:
        damping = 2.0 * zeta * sqrt(max(value**2 + axis.hull_stiffness, 0.0))
        return AxisGains(value**2, damping, axis.observer)

    # With a usual damping ratio first: what only a large one breaks is not the bandwidth's fault.
    usual = min(ratio, 1.0)
    name = f"control.gains.{{}} of {AXES[k]}".format
    require_stable(
        name("bandwidth_rad_s"), bandwidth, " rad/s", axis, lambda value: gains_at(value, usual)
    )
    require_stable(name("damping_ratio"), ratio, "", axis, lambda value: gains_at(bandwidth, value))
    return AxisDesign(axis, bandwidth, ratio, gains_at(bandwidth, ratio), "asked for")
