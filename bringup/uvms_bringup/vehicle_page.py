"""What `uvms vehicle` prints."""

import json
import math
import sys
from collections.abc import Iterator, Sequence
from typing import Any

from uvms_bringup.scenario import LONGEST_ECHO, VEHICLE_PREFIX
from uvms_bringup.vehicle_summary import vehicle_summary
from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import examine_vehicle
from uvms_core.yaml_text import parse_yaml

_KINDS = ("errors", "warnings", "notes")


def show_vehicle(name: str, settings: Sequence[str], as_json: bool) -> int:
    """Print all about the vehicle of that name or file; the exit code is 2 where it has errors."""
    try:
        found = examine_vehicle(name, dict(map(_setting, settings)))
    except VehicleFileError as fault:
        data: dict[str, Any] = {"errors": str(fault).splitlines(), "warnings": [], "notes": []}
        summary = None
    else:
        data = {"errors": [], "warnings": list(found.warnings), "notes": list(found.notes)}
        summary = vehicle_summary(found.vehicle)
    if as_json:
        print(json.dumps(finite(data | {"summary": summary}), indent=2))
    else:
        _print(data, summary)
    return 2 if data["errors"] else 0


def _setting(text: str) -> tuple[str, Any]:
    """Path and value of `PATH=VALUE`; the path may begin with `vehicle.`, as that of a scenario."""
    path, separator, value = text.partition("=")
    if not separator or not path:
        raise VehicleFileError(f"--set {text!r}: write PATH=VALUE, such as hull.mass_kg=190")
    what = f"--set {text[:LONGEST_ECHO]!r}"
    return path.removeprefix(VEHICLE_PREFIX), parse_yaml(value, what, VehicleFileError)


def finite(value: Any) -> Any:
    """Plain data without what JSON has no number for: None in the place of infinity."""
    if isinstance(value, dict):
        return {name: finite(each) for name, each in value.items()}
    if isinstance(value, list):
        return [finite(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _print(data: dict[str, Any], summary: dict[str, Any] | None) -> None:
    for line in data["errors"]:
        print(f"error: {line}", file=sys.stderr)
    for kind in _KINDS[1:]:
        for line in data[kind]:
            print(f"{kind[:-1]}: {line}")
    if summary is not None:
        print("\n".join(_lines(summary)))


def _lines(summary: dict[str, Any]) -> Iterator[str]:
    net = summary["net_buoyancy_n"]
    yield f"{summary['name']}"
    yield (
        f"  mass {summary['mass_kg']:.5g} kg, displaces {summary['displaced_kg']:.5g} kg:"
        f" {_net(net)}"
    )
    yield from _bodies(summary)
    yield from _floating(summary)
    yield from _clearance(summary)
    yield from _thrusters(summary)
    yield from _thrust(summary)
    yield from _joints(summary)
    yield from _electrical(summary["electrical"])
    yield "  sensors"
    for name, sensor in summary["sensors"].items():
        yield f"    {name:24} {sensor['rate_hz']:>7g} Hz  at {_vector(sensor['position_m'])} m"


def _electrical(found: dict[str, Any]) -> Iterator[str]:
    if "lacks" in found:
        yield f"  electrical power is not given: {found['lacks']}"
        return
    yield (
        f"  takes {found['hotel_load_w']:g} W at rest, {found['full_thrust_w']:.4g} W more with all"
        " thrusters at their limits"
    )
    if "battery_wh" in found:
        lasts = found.get("lasts_at_rest_h")
        rest = "" if lasts is None else f", {lasts:.3g} h at rest"
        yield f"  battery {found['battery_wh']:.4g} Wh, {found['battery_ah']:.4g} Ah{rest}"


def _net(newtons: float) -> str:
    if abs(newtons) < 5e-4:
        return "neutral"
    return f"{abs(newtons):.4g} N {'up' if newtons > 0.0 else 'down'}"


def _bodies(summary: dict[str, Any]) -> Iterator[str]:
    yield (
        f"  {'body':22}{'mass':>12} {'volume':>10} {'kg/m^3':>8}"
        f"   {'centre of gravity, m':>26}   {'centre of buoyancy, m':>26}"
    )
    for name, body in {"hull": summary["hull"], **summary["links"]}.items():
        yield (
            f"    {name:20}{body['mass_kg']:>9.4g} kg {1000.0 * body['volume_m3']:>8.4g} l"
            f" {body['density_kg_m3']:>8.4g}   {_vector(body['cg_m']):>26}"
            f"   {_vector(body['cb_m']):>26}"
        )


def _vector(values: Sequence[float]) -> str:
    return ", ".join(f"{round(value, 4) + 0.0:g}" for value in values)


def _floating(summary: dict[str, Any]) -> Iterator[str]:
    yield f"  {'floats with the arm':26}  roll  pitch   righting moment   metacentric height"
    for name, rest in summary["floating"].items():
        yield (
            f"    {name:24}{_degrees(rest['roll_deg'])} {_degrees(rest['pitch_deg'])}"
            f" {rest['righting_nm_per_deg']:>10.3g} N m/deg"
            f" {1000.0 * rest['metacentric_height_m']:>14.3g} mm"
        )
    periods = summary["periods_s"]
    yield f"  natural periods, arm stowed: roll {_seconds(periods['roll'])}, pitch" + (
        f" {_seconds(periods['pitch'])}"
    )


def _clearance(summary: dict[str, Any]) -> Iterator[str]:
    if summary["clearance"]:
        yield f"  {'least distance in posture':26}"
    for name, least in summary["clearance"].items():
        yield f"    {name:24}{1000.0 * least['least_m']:>6.1f} mm  {least['pair']}"


def _degrees(value: float) -> str:
    return f"{round(value, 1) + 0.0:>6.1f}"


def _seconds(value: float) -> str:
    return f"{value:.3g} s" if math.isfinite(value) else "none"


def _thrusters(summary: dict[str, Any]) -> Iterator[str]:
    """Limits of each thruster, and the thrusts around none that it cannot give."""
    yield f"  {'thruster':24}{'limits':>16}"
    for name, thruster in summary["thrusters"].items():
        (astern, ahead), least = thruster["limits_n"], thruster["least_n"]
        gap = f"  none, or beyond {least[0]:.3g} and {least[1]:.3g} N" if any(least) else ""
        yield f"    {name:22}{astern + 0.0:>9.4g} to {ahead:<6.4g} N{gap}"


def _thrust(summary: dict[str, Any]) -> Iterator[str]:
    yield "  thrusters reach, along one axis alone"
    for axis, (back, ahead) in summary["authority"].items():
        unit = "N" if axis in ("surge", "sway", "heave") else "N m"
        out = "  out of reach" if axis in summary["axes_out_of_reach"] else ""
        yield f"    {axis:8}{back + 0.0:>10.4g} to {ahead:<8.4g} {unit}{out}"
    if one_way := summary["axes_pushed_one_way"]:
        yield f"  not both ways, since thrusters do not reverse: {', '.join(one_way)}"
    speeds = ", ".join(f"{axis} {v:.3g} m/s" for axis, v in summary["speed_m_s"].items())
    yield f"  speed at that force, hull alone: {speeds}"


def _joints(summary: dict[str, Any]) -> Iterator[str]:
    yield f"  {'joint':26}  held at level   anywhere      drive      brake   (N m)"
    for name, joint in summary["joints"].items():
        brake = f"{joint['brake_nm']:.4g}" if joint["brake_nm"] else "none"
        yield (
            f"    {name:24}{_torque(joint['static_torque_nm']):>15.3g}"
            f" {_torque(joint['static_torque_anywhere_nm']):>10.3g}"
            f" {joint['effort_limit_nm']:>10.4g} {brake:>10}"
        )


def _torque(value: float) -> float:
    """Without the rounding of a zero."""
    return round(value, 9) + 0.0
