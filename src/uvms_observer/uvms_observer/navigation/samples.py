"""Samples of all sensors, checked and in the order of their stamps."""

from collections.abc import Callable, Iterable
from typing import Any

from uvms_core.signals import DvlSample, GpsSample, ImuSample, PressureSample
from uvms_observer import checks

Sample = ImuSample | DvlSample | PressureSample | GpsSample

NAMES: dict[type, str] = {
    ImuSample: "imu",
    DvlSample: "dvl",
    PressureSample: "pressure",
    GpsSample: "gps",
}
_ORDER = {kind: place for place, kind in enumerate(NAMES)}


def in_order(samples: Iterable[Sample]) -> list[Sample]:
    """Samples by stamp; of the same stamp the IMU first, which carries the state there."""
    return sorted(samples, key=lambda sample: (sample.stamp, _ORDER[type(sample)]))


def check(sample: Sample) -> None:
    """SignalError that names the value, if the sample has a wrong shape or is not finite."""
    _CHECKS[type(sample)](sample)


def _check_imu(sample: ImuSample) -> None:
    checks.quaternion("imu.quaternion", sample.quaternion)
    checks.array("imu.angular_velocity", sample.angular_velocity, (3,))
    checks.array("imu.linear_acceleration", sample.linear_acceleration, (3,))


def _check_dvl(sample: DvlSample) -> None:
    checks.array("dvl.velocity", sample.velocity, (3,))


def _check_pressure(sample: PressureSample) -> None:
    checks.number("pressure.pressure", sample.pressure)


def _check_gps(sample: GpsSample) -> None:
    if not sample.fix:
        return  # below the surface the position may be NaN
    checks.number("gps.latitude_deg", sample.latitude_deg)
    checks.number("gps.longitude_deg", sample.longitude_deg)
    checks.number("gps.altitude", sample.altitude)


_CHECKS: dict[type, Callable[[Any], None]] = {
    ImuSample: _check_imu,
    DvlSample: _check_dvl,
    PressureSample: _check_pressure,
    GpsSample: _check_gps,
}
