"""The sensors: rate, mounting (lever arm) and errors of each."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ConfigDict, Field, model_validator

from uvms_core.vehicle.further_sensors import Sensor, further_sections, section_class
from uvms_core.vehicle.parts import Part

__all__ = ["Dvl", "Encoders", "Gps", "Imu", "Pressure", "Sensor", "Sensors"]


class Imu(Sensor):
    """Gyrocompass and inertial unit, axes parallel to the body's; biases are Gauss-Markov."""

    roll_pitch_noise_deg: float = Field(ge=0.0, description="white noise of roll and pitch, deg")
    roll_pitch_bias_deg: float = Field(ge=0.0, description="std of their bias, deg")
    heading_noise_deg: float = Field(ge=0.0, description="white noise of the heading, deg")
    heading_bias_deg: float = Field(ge=0.0, description="std of its bias, deg")
    gyro_noise_deg_s: float = Field(ge=0.0, description="white noise per sample, deg/s")
    gyro_bias_deg_s: float = Field(ge=0.0, description="std of the bias, deg/s")
    accelerometer_noise_m_s2: float = Field(ge=0.0, description="white noise per sample, m/s^2")
    accelerometer_bias_m_s2: float = Field(ge=0.0, description="std of the bias, m/s^2")
    bias_time_constant_s: float = Field(gt=0.0, description="correlation time of the biases, s")


class Dvl(Sensor):
    """Doppler velocity log with bottom lock, axes parallel to the body's."""

    noise_m_s: float = Field(ge=0.0, description="white noise per axis and sample, m/s")
    scale_error: float = Field(ge=0.0, description="std of the constant scale error, a fraction")


class Pressure(Sensor):
    """Absolute pressure sensor."""

    noise_pa: float = Field(ge=0.0, description="white noise per sample, Pa")
    bias_pa: float = Field(ge=0.0, description="std of the constant bias, Pa")


class Gps(Sensor):
    """Satellite receiver; it has a fix only while the antenna is above the water."""

    horizontal_noise_m: float = Field(ge=0.0, description="white noise north and east, m")
    vertical_noise_m: float = Field(ge=0.0, description="white noise of the altitude, m")


class Encoders(Part):
    """Joint encoders, read at every control tick."""

    resolution_deg: float = Field(ge=0.0, description="step of the angle, degrees; 0 for none")
    noise_deg: float = Field(ge=0.0, description="white noise of the angle before rounding, deg")
    rate_noise_deg_s: float = Field(ge=0.0, description="white noise of the rate, deg/s")


class Sensors(Part):
    """All sensors of the vehicle: the built-in ones, and any that an installed package brings.

    The section of a further sensor has the name under which the package registers it in
    `uvms.sensors`.
    """

    model_config = ConfigDict(extra="allow")

    imu: Imu = Field(description="gyrocompass and inertial unit")
    dvl: Dvl = Field(description="Doppler velocity log")
    pressure: Pressure = Field(description="depth from pressure")
    gps: Gps = Field(description="satellite receiver")
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
        further = {name: data[name] for name in data if name not in cls.model_fields}
        return {**data, **further_sections(further, tuple(cls.model_fields))}

    @classmethod
    def field_model(cls, name: str) -> type[BaseModel] | None:
        """Class of a section, a further sensor's included."""
        return super().field_model(name) or section_class(name)
