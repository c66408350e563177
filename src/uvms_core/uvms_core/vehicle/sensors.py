"""The sensors: rate, mounting (lever arm) and errors of each.

All sensors err in the same ways. What is measured becomes

    measured = rounded((1 + scale) true + bias + walk + noise + outlier),

where `scale` and `bias` are constant in a run (or Gauss-Markov, where the section says so) and
drawn from their std at its start, `walk` is a random walk, `noise` is white, and an outlier is
added to a share of the samples. True vectors are first turned by the misalignment of the mount.
The fields' units are those of what is measured. All errors but the noise and the biases that a
section requires are none by default.
"""

import math
from collections.abc import Mapping
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from uvms_core.vehicle.further_sensors import (
    Sensor,
    WorldSensor,
    further_sections,
    kind_of,
    section_class,
)
from uvms_core.vehicle.parts import Part

__all__ = ["Dvl", "Encoders", "Gps", "Imu", "Instrument", "Pressure", "Sensor", "Sensors"]


def _none(description: str) -> Any:
    """Field of an error that is none by default."""
    return Field(default=0.0, ge=0.0, description=description)


def _bias(of: str, unit: str) -> Any:
    return _none(f"std of the constant bias of {of}, {unit}")


def _walk(of: str, unit: str) -> Any:
    return _none(
        f"random walk of {of}: its std after one second, which grows with the root of time, {unit}"
    )


def _scale(of: str) -> Any:
    return _none(f"std of the constant scale error of {of}, a fraction")


def _resolution(of: str, unit: str) -> Any:
    return _none(f"step to which {of} is rounded, {unit}; 0 for none")


def _outlier(of: str, unit: str) -> Any:
    return _none(f"std of what an outlier adds to {of}, {unit}")


def _misalignment() -> Any:
    return _none("std of the constant error of its mounting about each axis, deg")


class Outlying(Part):
    """What has outliers."""

    outlier_rate: float = Field(
        default=0.0, ge=0.0, le=1.0, description="probability that a sample is an outlier"
    )


class Instrument(Sensor, Outlying):
    """A built-in sensor that is mounted on the body."""


class Imu(Instrument, WorldSensor):
    """Gyrocompass and inertial unit; biases are Gauss-Markov."""

    orientation: bool = Field(
        default=True,
        description="whether it measures the attitude; if not, its noise and bias may be left out,"
        " and the vehicle needs a sensor of the heading",
    )
    roll_pitch_noise_deg: float = Field(ge=0.0, description="white noise of roll and pitch, deg")
    roll_pitch_bias_deg: float = Field(ge=0.0, description="std of their bias, deg")
    heading_noise_deg: float = Field(ge=0.0, description="white noise of the heading, deg")
    heading_bias_deg: float = Field(ge=0.0, description="std of its bias, deg")
    gyro_noise_deg_s: float = Field(ge=0.0, description="white noise per sample, deg/s")
    gyro_bias_deg_s: float = Field(ge=0.0, description="std of the bias, deg/s")
    accelerometer_noise_m_s2: float = Field(ge=0.0, description="white noise per sample, m/s^2")
    accelerometer_bias_m_s2: float = Field(ge=0.0, description="std of the bias, m/s^2")
    bias_time_constant_s: float = Field(gt=0.0, description="correlation time of the biases, s")
    misalignment_deg: float = _misalignment()
    attitude_random_walk_deg: float = _walk("the attitude's error about each axis", "deg")
    attitude_resolution_deg: float = _resolution("roll, pitch and heading", "deg")
    attitude_outlier_deg: float = _outlier("the attitude, about each axis", "deg")
    gyro_random_walk_deg_s: float = _walk("the rates' bias", "deg/s")
    gyro_scale_error: float = _scale("each rate")
    gyro_resolution_deg_s: float = _resolution("each rate", "deg/s")
    gyro_outlier_deg_s: float = _outlier("each rate", "deg/s")
    accelerometer_random_walk_m_s2: float = _walk("the specific force's bias", "m/s^2")
    accelerometer_scale_error: float = _scale("the specific force along each axis")
    accelerometer_resolution_m_s2: float = _resolution("the specific force", "m/s^2")
    accelerometer_outlier_m_s2: float = _outlier("the specific force along each axis", "m/s^2")

    @model_validator(mode="before")
    @classmethod
    def _attitude_only_if_measured(cls, data: Any) -> Any:
        if isinstance(data, Mapping) and data.get("orientation") is False:
            return {**dict.fromkeys(_OF_ATTITUDE, 0.0), **data}
        return data


_OF_ATTITUDE = (
    "roll_pitch_noise_deg",
    "roll_pitch_bias_deg",
    "heading_noise_deg",
    "heading_bias_deg",
)


class Dvl(Instrument):
    """Doppler velocity log; without lock there is no sample."""

    message: Literal[
        "geometry_msgs/msg/TwistWithCovarianceStamped", "marine_acoustic_msgs/msg/Dvl"
    ] = Field(
        default="geometry_msgs/msg/TwistWithCovarianceStamped",
        description="type of its messages; marine_acoustic_msgs must be installed for the second",
    )
    lock: Literal["bottom", "water"] = Field(
        default="bottom",
        description="against what it measures where its messages do not say: the bottom, or the"
        " water",
    )

    noise_m_s: float = Field(ge=0.0, description="white noise per axis and sample, m/s")
    scale_error: float = Field(ge=0.0, description="std of the constant scale error, a fraction")
    bias_m_s: float = _bias("the velocity along each axis", "m/s")
    random_walk_m_s: float = _walk("that bias", "m/s")
    misalignment_deg: float = _misalignment()
    resolution_m_s: float = _resolution("the velocity along each axis", "m/s")
    outlier_m_s: float = _outlier("the velocity along each axis", "m/s")
    min_altitude_m: float = Field(
        default=0.0,
        ge=0.0,
        description="bottom lock is lost below this altitude above the seabed, m",
    )
    max_altitude_m: float | None = Field(
        default=None, gt=0.0, description="and above this altitude, m; none: never"
    )
    max_tilt_deg: float | None = Field(
        default=None,
        gt=0.0,
        le=180.0,
        description="and where the vehicle is tilted from the vertical by more, deg; none: never",
    )

    def reaches(self, altitude: float, down: float) -> bool:
        """Whether there is bottom lock.

        Args:
            altitude: of the transducer above the seabed, m; infinity where no seabed is given.
            down: cosine of the vehicle's tilt from the vertical.
        """
        if self.max_tilt_deg is not None and down < math.cos(math.radians(self.max_tilt_deg)):
            return False
        if math.isinf(altitude):
            return True
        most = self.max_altitude_m or math.inf
        return max(self.min_altitude_m, 0.0) <= altitude <= most

    @model_validator(mode="after")
    def _some_altitude_is_left(self) -> "Dvl":
        if self.max_altitude_m is not None and self.max_altitude_m <= self.min_altitude_m:
            raise ValueError(
                f"max_altitude_m = {self.max_altitude_m:g} m must be above min_altitude_m ="
                f" {self.min_altitude_m:g} m"
            )
        return self


class Pressure(Instrument):
    """Absolute pressure sensor."""

    noise_pa: float = Field(ge=0.0, description="white noise per sample, Pa")
    bias_pa: float = Field(ge=0.0, description="std of the constant bias, Pa")
    random_walk_pa: float = _walk("that bias", "Pa")
    scale_error: float = _scale("the absolute pressure")
    resolution_pa: float = _resolution("the pressure", "Pa")
    outlier_pa: float = _outlier("the pressure", "Pa")


class Gps(Instrument):
    """Satellite receiver; it has a fix only while the antenna is above the water."""

    horizontal_noise_m: float = Field(ge=0.0, description="white noise north and east, m")
    vertical_noise_m: float = Field(ge=0.0, description="white noise of the altitude, m")
    horizontal_bias_m: float = _bias("north and east", "m")
    vertical_bias_m: float = _bias("the altitude", "m")
    horizontal_random_walk_m: float = _walk("the bias of north and east", "m")
    vertical_random_walk_m: float = _walk("the bias of the altitude", "m")
    resolution_m: float = _resolution("north, east and altitude", "m")
    outlier_m: float = _outlier("north, east and altitude", "m")


class Encoders(Outlying):
    """Joint encoders, read at every control tick: they have no latency and no drop-outs."""

    resolution_deg: float = Field(ge=0.0, description="step of the angle, degrees; 0 for none")
    noise_deg: float = Field(ge=0.0, description="white noise of the angle before rounding, deg")
    rate_noise_deg_s: float = Field(ge=0.0, description="white noise of the rate, deg/s")
    bias_deg: float = _bias("each angle", "deg")
    outlier_deg: float = _outlier("each angle", "deg")


BUILT_IN: dict[str, type[Sensor]] = {"imu": Imu, "dvl": Dvl, "pressure": Pressure, "gps": Gps}
"""Sections of the sensors that every installation knows, by kind."""


class Sensors(Part):
    """All sensors of the vehicle; only the inertial unit and the encoders must be there.

    The section of a further sensor has the name under which a package registers it in
    `uvms.sensors`, or any other name and that as its `type`: a vehicle may have two of a kind.
    """

    model_config = ConfigDict(extra="allow")

    imu: Imu = Field(description="gyrocompass and inertial unit")
    dvl: Dvl | None = Field(default=None, description="Doppler velocity log; none: it has none")
    pressure: Pressure | None = Field(
        default=None, description="depth from pressure; none: it has none"
    )
    gps: Gps | None = Field(default=None, description="satellite receiver; none: it has none")
    encoders: Encoders = Field(description="joint encoders")

    @property
    def mounted(self) -> dict[str, Sensor]:
        """Sections of the sensors that are mounted on the body, by name."""
        return {name: section for name, section in self if isinstance(section, Sensor)}

    @model_validator(mode="before")
    @classmethod
    def _check_further(cls, data: Any) -> Any:
        if not isinstance(data, Mapping):
            return data
        own = {name: value for name, value in data.items() if name in cls.model_fields}
        further = {name: data[name] for name in data if name not in own and data[name] is not None}
        return {**own, **further_sections(further, BUILT_IN)}

    @model_validator(mode="after")
    def _one_inertial_unit(self) -> "Sensors":
        for name, section in self.mounted.items():
            kind = kind_of(name, section)
            if name != "imu" and kind == "imu":
                raise ValueError(
                    f"{name} is a second imu: one inertial unit alone carries the estimate. Give"
                    " its attitude as a sensor of type heading, or leave it out"
                )
            if name in BUILT_IN and kind != name:
                raise ValueError(f"{name}.type is {kind!r}; a section of this name is a {name}")
        return self

    @classmethod
    def field_model(cls, name: str) -> type[BaseModel] | None:
        """Class of a section, a further sensor's included."""
        return super().field_model(name) or section_class(name)
