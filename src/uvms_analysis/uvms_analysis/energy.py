"""What a run took from its supply: electrical power, energy by consumer, share of the battery.

Power follows from the true thrusts, torques and rates and from what the vehicle file says that they
take (`uvms_dynamics.power`); what is left of the battery is what `battery_state` says.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis, at_common_stamps
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import Series
from uvms_core import topics
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.power import PowerDraw

SECONDS_AN_HOUR = 3600.0

ENERGY = (
    "total_wh",
    "propulsion_wh",
    "arm_wh",
    "hotel_wh",
    "power_mean_w",
    "power_max_w",
    "thrusters_wh",
)
BATTERY = ("used", "left", "least_voltage_v", "lasts_h")
"""Names of the figures of `energy` and `battery`."""


@dataclass(frozen=True)
class Power:
    """Electrical power over time, W."""

    time: Array  # (k,) s
    thrusters: Array  # (k, m)
    arm: Array  # (k,)
    hotel: Array  # (k,)

    @property
    def total(self) -> Array:
        """All of it, (k,)."""
        return self.thrusters.sum(axis=1) + self.arm + self.hotel


def electrical_power(run: Analysis) -> Power:
    """Power at each control tick, by the plant's own vehicle file.

    Raises:
        LogError: the log lacks thrusts, joints or vehicle, or the vehicle file does not say what
            they take.
    """
    vehicle = run.log.plant_vehicle
    if vehicle.lacks_power:
        raise LogError(vehicle.lacks_power)
    draw = PowerDraw(vehicle)
    applied, joints = at_common_stamps(
        run.log.series(topics.APPLIED_THRUST), run.log.series(topics.TRUE_JOINT_STATES)
    )
    if applied.thrust.shape[1:] != (vehicle.n_thrusters,):
        raise LogError(f"{applied.thrust.shape[1]} thrusts of {vehicle.n_thrusters} thrusters")
    on = _has_power(run, applied)
    return Power(
        applied.time,
        draw.thrusters(applied.thrust) * on[:, None],
        draw.arm(joints.effort, joints.velocity) * on,
        draw.hotel * on,
    )


def _has_power(run: Analysis, at: Series) -> Array:
    """1 at each time of a series (k,), 0 from where the battery says that it is empty on.

    It says so once a second, so that a run that empties it is given up to a second too much.
    """
    if not run.log.has(topics.BATTERY_STATE):
        return np.ones(len(at))
    said = run.log.series(topics.BATTERY_STATE)
    empty = said.stamps[said.percentage <= 0.0]
    return (at.stamps < empty[0]).astype(float) if len(empty) else np.ones(len(at))


def energy(run: Analysis) -> dict[str, Any]:
    """Energy in Wh, all and by consumer, mean and greatest power in W.

    Raises as `electrical_power`.
    """
    power = electrical_power(run)
    total, each = power.total, _watt_hours(power.time, power.thrusters)
    if len(total) < 2:
        raise LogError("there is one control tick only")
    sum_wh = float(_watt_hours(power.time, total))
    return {
        "total_wh": sum_wh,
        "propulsion_wh": float(each.sum()),
        "arm_wh": float(_watt_hours(power.time, power.arm)),
        "hotel_wh": float(_watt_hours(power.time, power.hotel)),
        "power_mean_w": sum_wh * SECONDS_AN_HOUR / float(power.time[-1] - power.time[0]),
        "power_max_w": float(total.max()),
        "thrusters_wh": dict(zip(run.vehicle.thruster_names, each.tolist(), strict=True)),
    }


def _watt_hours(time: Array, power: Array) -> Array:
    return np.asarray(np.trapezoid(power, time, axis=0)) / SECONDS_AN_HOUR


def battery(run: Analysis) -> dict[str, float | None]:
    """Share of the battery that was used and is left, its least voltage, and how long it lasts.

    `lasts_h` is from full to empty at the rate of the run, h; None where nothing was taken.

    Raises:
        LogError: the vehicle has no battery, or the log no `battery_state`.
    """
    said = battery_series(run)
    share = said.percentage
    empty = np.flatnonzero(share <= 0.0)
    last = int(empty[0]) if len(empty) else len(share) - 1  # after that nothing is taken
    hours = float(said.time[last] - said.time[0]) / SECONDS_AN_HOUR
    used = float(share[0] - share[-1])
    return {
        "used": used,
        "left": float(share[-1]),
        "least_voltage_v": float(said.voltage.min()),
        "lasts_h": hours / used if used > 0.0 else None,
    }


def battery_series(run: Analysis) -> Series:
    """What the battery says over time, where its charge is known; raises as `battery`."""
    if not run.log.has(topics.BATTERY_STATE):
        raise LogError(_why_no_battery(run.log.plant_vehicle))
    said = run.log.series(topics.BATTERY_STATE)
    known = said.take(np.flatnonzero(np.isfinite(said.percentage)))
    if not len(known):
        raise LogError(f"{topics.BATTERY_STATE.name} never says how much is left")
    return known


def _why_no_battery(vehicle: Vehicle) -> str:
    if vehicle.battery is None:
        return vehicle.lacks_power or "the vehicle file gives no `electrical.battery`"
    return f"the log has no {topics.BATTERY_STATE.name}, although the vehicle has a battery"
