"""All sensors of the vehicle, each with its own generator of random numbers."""

from collections.abc import Callable
from dataclasses import dataclass

from uvms_core.signals import (
    Array,
    DvlSample,
    GpsSample,
    ImuSample,
    JointStates,
    PressureSample,
    to_nanoseconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.sensors.dvl import DvlSensor
from uvms_dynamics.simulation.sensors.encoders import EncoderSensor
from uvms_dynamics.simulation.sensors.gps import GpsSensor
from uvms_dynamics.simulation.sensors.imu import ImuSensor
from uvms_dynamics.simulation.sensors.mounting import Trajectory
from uvms_dynamics.simulation.sensors.pressure import PressureSensor


@dataclass(frozen=True)
class SensorFrame:
    """All samples since the last control tick, this one's included."""

    imu: tuple[ImuSample, ...]
    dvl: tuple[DvlSample, ...]
    pressure: tuple[PressureSample, ...]
    gps: tuple[GpsSample, ...]
    joints: JointStates


class SensorSuite:
    """IMU, DVL, pressure, GPS and encoders, each at its own rate, due at multiples of its period.

    `check(period, name)` is called with each period in ns and may refuse it.
    """

    def __init__(self, vehicle: Vehicle, seed: int, check: Callable[[int, str], object]) -> None:
        sensors, environment = vehicle.sensors, vehicle.environment
        periods = {}
        for name in ("imu", "dvl", "pressure", "gps"):
            periods[name] = to_nanoseconds(1.0 / getattr(sensors, name).rate_hz)
            check(periods[name], f"sensors.{name}.rate_hz")
        self._imu = ImuSensor(sensors.imu, environment.gravity_m_s2, periods["imu"], seed)
        self._dvl = DvlSensor(sensors.dvl, periods["dvl"], seed)
        self._pressure = PressureSensor(sensors.pressure, environment, periods["pressure"], seed)
        self._gps = GpsSensor(sensors.gps, environment, periods["gps"], seed)
        self._encoders = EncoderSensor(sensors.encoders, seed)

    def sample(self, trajectory: Trajectory, q: Array, q_dot: Array, effort: Array) -> SensorFrame:
        """Samples on the trajectory, and the encoders at its end."""
        return SensorFrame(
            self._imu.sample(trajectory),
            self._dvl.sample(trajectory),
            self._pressure.sample(trajectory),
            self._gps.sample(trajectory),
            self._encoders.sample(trajectory.stamps[-1], q, q_dot, effort),
        )
