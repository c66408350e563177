"""The sensors: rate, mounting (lever arm) and errors of each."""

from pydantic import Field

from uvms_core.vehicle.parts import Part, Vector3


class Sensor(Part):
    """What every mounted sensor has."""

    rate_hz: float = Field(gt=0.0, description="samples per second")
    position_m: Vector3 = Field(description="lever arm: sensor in the body frame, m")


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
    """All sensors of the vehicle."""

    imu: Imu = Field(description="gyrocompass and inertial unit")
    dvl: Dvl = Field(description="Doppler velocity log")
    pressure: Pressure = Field(description="depth from pressure")
    gps: Gps = Field(description="satellite receiver")
    encoders: Encoders = Field(description="joint encoders")
