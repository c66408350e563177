"""Parameters of the navigation filter; the sensors' noise is in the vehicle file."""

from typing import ClassVar, Literal

from pydantic import Field

from uvms_core import registry
from uvms_core.config import Config
from uvms_core.plugin import PluginConfig, Slot
from uvms_core.start import StartConfig
from uvms_observer.interfaces import NavigationEstimator


class NoiseFloor(Config):
    """Lower bounds of the measurement noise (std) that the filter assumes."""

    attitude_deg: float = Field(0.001, gt=0.0, description="roll, pitch and heading, deg")
    velocity_m_s: float = Field(1e-4, gt=0.0, description="DVL, m/s")
    depth_m: float = Field(1e-4, gt=0.0, description="pressure sensor, m of water")
    misalignment_deg: float = Field(
        0.5,
        gt=0.0,
        description="mounting of the DVL about each axis, deg: what hands and a tape measure leave"
        " where it has not been calibrated",
    )
    position_m: float = Field(1e-2, gt=0.0, description="GPS, m")
    fix_m: float = Field(1e-3, gt=0.0, description="position fix under water, m")


class NavigationConfig(PluginConfig, StartConfig):
    """How the navigation filter starts and how far it trusts model and sensors."""

    slot: ClassVar[Slot] = Slot(registry.NAVIGATION_FILTERS, "filter", NavigationEstimator)

    source: Literal["sensors", "truth"] = Field(
        "sensors",
        description="sensors (the filter), or truth: the simulation's own state instead of an"
        " estimate, as a baseline, which no real vehicle has",
    )
    filter: str = Field(
        "error_state_ekf",
        description="navigation filter: error_state_ekf (eq. (20)), that of an installed package,"
        " or a class as my_package.my_module:MyFilter",
    )
    start: Literal["given", "fixes"] = Field(
        "given",
        description="where the filter begins: `given`, by the fields initial_*; `fixes`, anywhere,"
        " until position and velocity have been measured, and nothing is published before that."
        " The attitude is that of the first IMU sample in either case",
    )
    initial_velocity_m_s: tuple[float, float, float] = Field(
        (0.0, 0.0, 0.0),
        description="of the body origin over ground at the start, map_ned, m/s; start: given",
    )
    known_within_m: float = Field(
        10.0,
        gt=0.0,
        le=1000.0,
        description="with start: fixes, std of north, east and depth each, m, below which the"
        " estimate is published: what a fix of a usual receiver or acoustic system gives",
    )
    known_within_m_s: float = Field(
        0.5,
        gt=0.0,
        le=10.0,
        description="and that of the velocity along each axis, m/s",
    )
    initial_position_std_m: float = Field(
        0.01, gt=0.0, description="std of the initial north and east, m"
    )
    initial_depth_std_m: float = Field(
        100.0, gt=0.0, description="std of the initial depth before the first pressure sample, m"
    )
    initial_velocity_std_m_s: float = Field(
        0.5, gt=0.0, description="std of the initial velocity, m/s"
    )
    gyro_noise_scale: float = Field(
        1.0, gt=0.0, le=1000.0, description="factor on the gyro noise of the vehicle file"
    )
    accelerometer_noise_scale: float = Field(
        1.0, gt=0.0, le=1000.0, description="factor on the accelerometer noise of the vehicle file"
    )
    current_std_m_s: float = Field(
        0.3, gt=0.0, description="std of the water current north and east, m/s"
    )
    current_time_constant_s: float = Field(
        600.0, gt=0.0, description="correlation time of the water current, s"
    )
    hull_model_error: float = Field(
        0.2,
        gt=0.0,
        le=1.0,
        description="share by which thrust and drag of the vehicle file may be wrong, where the"
        " thrusts tell the velocity because no sensor does",
    )
    unmodelled_force: float = Field(
        0.03,
        gt=0.0,
        le=1.0,
        description="std of the force that acts on the vehicle beside thrust and drag, such as a"
        " tether's, as a share of all that its thrusters have along the axis",
    )
    latency_s: float = Field(
        0.25,
        ge=0.0,
        le=10.0,
        description="largest delay of a sample that is still used, at its own stamp, s",
    )
    gate_probability: float = Field(
        0.9999,
        gt=0.5,
        lt=1.0,
        description="share of good measurements that the chi-square gate accepts",
    )
    noise_floor: NoiseFloor = NoiseFloor()
