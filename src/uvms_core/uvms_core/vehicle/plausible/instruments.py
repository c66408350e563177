"""Sensors: rates and errors that no instrument has."""

from collections.abc import Iterator

from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.sensors import Sensors
from uvms_core.vehicle.vehicle import Vehicle

RATE_HZ = (0.01, 10_000.0)
"""An underwater fix every other minute; the fastest inertial units."""

WORST = {
    "imu.roll_pitch_noise_deg": 10.0,
    "imu.roll_pitch_bias_deg": 10.0,
    "imu.heading_noise_deg": 45.0,
    "imu.heading_bias_deg": 45.0,
    "imu.gyro_noise_deg_s": 10.0,
    "imu.gyro_bias_deg_s": 10.0,
    "imu.accelerometer_noise_m_s2": 5.0,
    "imu.accelerometer_bias_m_s2": 2.0,
    "dvl.noise_m_s": 1.0,
    "dvl.scale_error": 0.2,
    "pressure.noise_pa": 1e5,
    "pressure.bias_pa": 1e5,
    "gps.horizontal_noise_m": 100.0,
    "gps.vertical_noise_m": 200.0,
    "encoders.resolution_deg": 10.0,
    "encoders.noise_deg": 10.0,
    "encoders.rate_noise_deg_s": 30.0,
    "imu.misalignment_deg": 10.0,
    "imu.attitude_random_walk_deg": 1.0,
    "imu.attitude_resolution_deg": 10.0,
    "imu.gyro_random_walk_deg_s": 1.0,
    "imu.gyro_scale_error": 0.2,
    "imu.gyro_resolution_deg_s": 10.0,
    "imu.accelerometer_random_walk_m_s2": 0.5,
    "imu.accelerometer_scale_error": 0.2,
    "imu.accelerometer_resolution_m_s2": 1.0,
    "dvl.bias_m_s": 0.5,
    "dvl.random_walk_m_s": 0.1,
    "dvl.misalignment_deg": 20.0,
    "dvl.resolution_m_s": 0.5,
    "pressure.random_walk_pa": 1e4,
    "pressure.scale_error": 0.2,
    "pressure.resolution_pa": 1e5,
    "gps.horizontal_bias_m": 100.0,
    "gps.vertical_bias_m": 200.0,
    "gps.horizontal_random_walk_m": 10.0,
    "gps.vertical_random_walk_m": 20.0,
    "gps.resolution_m": 100.0,
    "encoders.bias_deg": 30.0,
}
"""About ten times what the cheapest instrument of its kind has: a compass beside a motor, a phone's
inertial unit, ten metres of water for a depth gauge. With more it measures nothing."""

MOST_LOST = 0.5
"""Share of the samples that may be lost or be outliers: with more the exception is the rule."""

SLOWEST_S = 2.0
"""Latency, s: an acoustic fix from a ship two miles away."""

SHORTEST_BIAS_S = 1.0
"""A bias that changes faster is noise."""


def check_instruments(vehicle: Vehicle) -> Iterator[Finding]:
    """Rates, noise and biases of all sensors; warnings, since a test may be meant."""
    sensors = vehicle.sensors
    for name, section in sensors.mounted.items():
        low, high = RATE_HZ
        if not low <= section.rate_hz <= high:
            text = f"{section.rate_hz:g} Hz, outside {low:g} to {high:g} Hz: no instrument has it"
            yield Finding(f"sensors.{name}.rate_hz", text)
        if section.latency_s > SLOWEST_S:
            text = f"{section.latency_s:g} s, more than {SLOWEST_S:g} s: too old to steer by"
            yield Finding(f"sensors.{name}.latency_s", text)
    yield from _shares(sensors)
    for path, worst in WORST.items():
        name, _, field = path.partition(".")
        section = getattr(sensors, name)
        value = 0.0 if section is None else float(getattr(section, field))
        if value > worst:
            text = f"{value:g} is more than {worst:g}: with so large an error it measures nothing"
            yield Finding(f"sensors.{path}", text)
    if sensors.imu.bias_time_constant_s < SHORTEST_BIAS_S:
        text = f"{sensors.imu.bias_time_constant_s:g} s, less than {SHORTEST_BIAS_S:g} s: a bias"
        yield Finding("sensors.imu.bias_time_constant_s", f"{text} that changes so fast is noise")


def _shares(sensors: Sensors) -> Iterator[Finding]:
    for name, section in sensors:
        for field in ("drop_out_rate", "outlier_rate"):
            share = getattr(section, field, 0.0)
            if share > MOST_LOST:
                text = f"{share:g} is more than {MOST_LOST:g}: most of its samples are of no use"
                yield Finding(f"sensors.{name}.{field}", text)
