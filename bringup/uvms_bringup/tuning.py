"""The gains that follow from a vehicle file and a control period, as data: `uvms tune`."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from uvms_control.config import GainConfig
from uvms_control.controlled_axes import AXES
from uvms_control.design.bandwidth import AxisDesign
from uvms_control.design.gains import axis_designs
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.plausible.stability import postures
from uvms_core.vehicle.postures import posture_deg


def tuning(
    vehicle: Vehicle, period: float, config: GainConfig, posture: str | None
) -> dict[str, Any]:
    """Plain data for people and scripts; names carry units, inf where there is no bound.

    `posture`: of the arm; None: all of the vehicle file, and the one that allows least decides.

    Raises:
        ConfigError: the vehicle has no such posture.
        ControlSetupError: a gain of the configuration makes the loop unstable.
    """
    chosen = dict(postures(vehicle))
    if posture is not None:
        posture_deg(vehicle.arm, posture)  # refuses an unknown one
        chosen = {posture: chosen[posture]}
    designs = axis_designs(vehicle, period, config, list(chosen.values()))
    alone = {name: axis_designs(vehicle, period, config, [q]) for name, q in chosen.items()}
    found = {
        name: _axis(designs[k], _deciding(designs[k], k, alone)) for k, name in enumerate(AXES)
    }
    return {
        "vehicle": vehicle.name,
        "control_period_s": period,
        "postures": list(chosen),
        "axes": {name: axis for name, axis in found.items() if axis is not None},
        "left_to_the_hull": [name for name, axis in found.items() if axis is None],
    }


def _deciding(
    design: AxisDesign | None, k: int, alone: Mapping[str, tuple[AxisDesign | None, ...]]
) -> str:
    return next(name for name, designs in alone.items() if designs[k] == design)


def _axis(design: AxisDesign | None, posture: str) -> dict[str, Any] | None:
    """Figures of one axis; forces are N or N m, errors m or rad."""
    if design is None:
        return None
    axis, gains, margins = design.axis, design.gains, design.margins
    share = axis.inertia * gains.stiffness / axis.authority
    return {
        "inertia": axis.inertia,
        "righting_nm_per_rad": axis.righting,
        "authority": axis.authority,
        "thruster_lag_s": axis.lag,
        "stiffness_1_s2": gains.stiffness,
        "damping_1_s": gains.damping,
        "bandwidth_rad_s": design.bandwidth,
        "damping_ratio": margins.damping_ratio,
        "observer_bandwidth_rad_s": gains.observer,
        "crossover_rad_s": margins.bandwidth,
        "delay_margin_s": margins.delay_margin,
        "delay_margin_periods": margins.delay_margin / axis.period,
        "gain_margin": margins.gain_margin,
        "phase_margin_deg": float(np.degrees(margins.phase_margin)),
        "noise_share": margins.noise_share,
        "authority_share_at_unit_error": share,
        "error_at_full_authority": 1.0 / share if share > 0.0 else np.inf,
        "limited_by": design.limited_by,
        "posture": posture,
    }
