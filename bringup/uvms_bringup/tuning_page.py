"""What `uvms tune` prints."""

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from uvms_bringup.scenario import VEHICLE_PREFIX, load_scenario
from uvms_bringup.tuning import tuning
from uvms_bringup.vehicle_page import finite
from uvms_core.errors import UvmsError

SCENARIO = "hover"
"""What a setting of the control is a change of; nothing else of it is used."""
CONTROL_PREFIX = "control."
ROTATIONS = ("roll", "pitch", "yaw")
HEADER = (
    f"  {'axis':6}{'inertia':>13}{'righting':>14}{'authority':>11}{'lag':>8}{'bandwidth':>12}"
    f"{'damping':>9}{'observer':>13}{'delay margin':>23}{'gain margin':>13}{'noise':>9}"
    f"{'full at':>11}   limited by"
)


def show_tuning(
    name: str,
    period: float | None,
    posture: str | None,
    settings: Sequence[str],
    as_json: bool,
) -> int:
    """Print the gains for the vehicle of that name or file; 2 where something is not right."""
    given = [_placed(setting) for setting in settings]
    values = {} if period is None else {"plant.control_period_s": period}
    try:
        scenario = load_scenario(SCENARIO, given, values, vehicle=name)
        vehicle = scenario.load_vehicle()
        period_s = scenario.plant.control_period_s
        found = tuning(vehicle, period_s, scenario.control.gains, posture)
    except UvmsError as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    print(json.dumps(finite(found), indent=2) if as_json else "\n".join(_lines(found)))
    return 0


def _placed(setting: str) -> str:
    """The setting as a scenario has it: a path that is none of the control is the vehicle's."""
    if setting.startswith((CONTROL_PREFIX, VEHICLE_PREFIX)):
        return setting
    return VEHICLE_PREFIX + setting


def _lines(found: Mapping[str, Any]) -> Iterator[str]:
    names = ", ".join(found["postures"])
    yield f"{found['vehicle']}, control period {found['control_period_s']:g} s, arm {names}"
    yield HEADER
    for name, axis in found["axes"].items():
        yield _line(name, axis, len(found["postures"]) > 1)
    for name in found["left_to_the_hull"]:
        yield f"  {name:6}left to the hull: the thrusters cannot control it beside the others"


def _line(name: str, axis: Mapping[str, Any], several: bool) -> str:
    turns = name in ROTATIONS
    delay = f"{_number(axis['delay_margin_s'])} s ({axis['delay_margin_periods']:.1f} periods)"
    why = axis["limited_by"] + (f" (arm {axis['posture']})" if several else "")
    cells = (
        f"{_number(axis['inertia'])} {'kg m²' if turns else 'kg'}:13",
        f"{_righting(axis['righting_nm_per_rad'])}:14",
        f"{_number(axis['authority'])} {'N m' if turns else 'N'}:11",
        f"{_number(axis['thruster_lag_s'])} s:8",
        f"{_number(axis['bandwidth_rad_s'])} rad/s:12",
        f"{axis['damping_ratio']:.2f}:9",
        f"{_number(axis['observer_bandwidth_rad_s'])} rad/s:13",
        f"{delay}:23",
        f"{_number(axis['gain_margin'])}:13",
        f"{100.0 * axis['noise_share']:.2g} %:9",
        f"{_number(axis['error_at_full_authority'])} {'rad' if turns else 'm'}:11",
    )
    texts = (cell.rsplit(":", 1) for cell in cells)
    return f"  {name:6}" + "".join(text.rjust(int(width)) for text, width in texts) + f"   {why}"


def _righting(value: float) -> str:
    return "-" if value == 0.0 else f"{_number(value)} N m/rad"


def _number(value: float) -> str:
    return "any" if value == float("inf") else f"{value:.3g}"
