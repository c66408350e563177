"""All sensors of the vehicle, each with its own generator of random numbers."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from uvms_core import checks, registry
from uvms_core.sensors import INERTIAL, sensor_types
from uvms_core.signals import (
    Array,
    DvlSample,
    GpsSample,
    ImuSample,
    JointStates,
    PressureSample,
    to_nanoseconds,
)
from uvms_core.topic import Topic
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.sensors.delivery import Delivery
from uvms_dynamics.simulation.sensors.encoders import EncoderSensor
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import Trajectory


@dataclass(frozen=True)
class SensorFrame:
    """All samples since the last control tick, this one's included: by sensor, and the joints."""

    samples: Mapping[str, tuple[Any, ...]]
    joints: JointStates

    @property
    def imu(self) -> tuple[ImuSample, ...]:
        """Of the gyrocompass and inertial unit."""
        return self.samples["imu"]

    @property
    def dvl(self) -> tuple[DvlSample, ...]:
        """Of the Doppler velocity log."""
        return self.samples["dvl"]

    @property
    def pressure(self) -> tuple[PressureSample, ...]:
        """Of the pressure sensor."""
        return self.samples["pressure"]

    @property
    def gps(self) -> tuple[GpsSample, ...]:
        """Of the satellite receiver."""
        return self.samples["gps"]


class SensorSuite:
    """The sensors of the vehicle file, each at its own rate, due at multiples of its period.

    Args:
        vehicle: its sensors' models are found by name in `uvms.sensors`.
        seed: of the run.
        check: called with each period in ns and the name of its field; may refuse it.

    Raises:
        PluginError: a sensor of the file has no model.
    """

    def __init__(self, vehicle: Vehicle, seed: int, check: Callable[[int, str], object]) -> None:
        self._models: dict[str, SensorModel] = {}
        self.deliveries: dict[str, Delivery] = {}
        """When the samples of each sensor come, and whether."""
        for name, section in vehicle.sensors.mounted.items():
            period = to_nanoseconds(1.0 / section.rate_hz)
            check(period, f"sensors.{name}.rate_hz")
            make = registry.load(registry.SENSORS, name)
            self._models[name] = make(vehicle, section, period, seed)
            self.deliveries[name] = Delivery(name, section, seed)
        self._encoders = EncoderSensor(vehicle.sensors.encoders, seed)

    def sample(self, trajectory: Trajectory, q: Array, q_dot: Array, effort: Array) -> SensorFrame:
        """Samples on a trajectory that is finite, and those of the encoders at its end."""
        now = trajectory.stamps[-1]
        return SensorFrame(
            {
                name: self.deliveries[name].deliver(checks.trust_all(model.sample(trajectory)), now)
                for name, model in self._models.items()
            },
            checks.trust(self._encoders.sample(now, q, q_dot, effort)),
        )


def in_order_of_publication(vehicle: Vehicle) -> tuple[tuple[str, Topic], ...]:
    """Name and topic of each sensor; the inertial one comes last, since it starts the next tick."""
    types = sorted(sensor_types(vehicle), key=lambda sensor: sensor is INERTIAL)
    return tuple((sensor.name, sensor.topic) for sensor in types)
