"""All sensors of the vehicle, each with its own generator of random numbers."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from uvms_core import checks, registry
from uvms_core.rng import generator
from uvms_core.sensors import INERTIAL, MountedSensor, mounted_sensors
from uvms_core.signals import (
    NOTHING_YET,
    Array,
    DvlSample,
    GpsSample,
    ImuSample,
    JointStates,
    PressureSample,
    SensorGaps,
    to_nanoseconds,
)
from uvms_core.topic import Topic
from uvms_core.topics import ENCODERS
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.events.sensor import SensorEvent
from uvms_dynamics.simulation.sensors.delivery import Delivery
from uvms_dynamics.simulation.sensors.encoders import EncoderSensor
from uvms_dynamics.simulation.sensors.faults import FaultLine
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import Trajectory


@dataclass(frozen=True)
class SensorFrame:
    """What has come since the last control tick, at this one included: by sensor, and the joints.

    Attributes:
        joints: the newest joint states that have come by now.
        joint_samples: those that have come since the last tick: none or several where they are
            late, else one.
    """

    samples: Mapping[str, tuple[Any, ...]]
    joints: JointStates
    joint_samples: tuple[JointStates, ...]
    gaps: SensorGaps | None = None
    """Which sensors did not give what was due, where there are any."""

    @property
    def imu(self) -> tuple[ImuSample, ...]:
        """Of the gyrocompass and inertial unit."""
        return self.samples["imu"]

    @property
    def dvl(self) -> tuple[DvlSample, ...]:
        """Of the Doppler velocity log."""
        return self.samples.get("dvl", ())

    @property
    def pressure(self) -> tuple[PressureSample, ...]:
        """Of the pressure sensor."""
        return self.samples.get("pressure", ())

    @property
    def gps(self) -> tuple[GpsSample, ...]:
        """Of the satellite receiver."""
        return self.samples.get("gps", ())


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
        for sensor in mounted_sensors(vehicle):
            name, section = sensor.name, sensor.section
            period = to_nanoseconds(1.0 / section.rate_hz)
            check(period, f"sensors.{name}.rate_hz")
            make = registry.load(registry.SENSORS, sensor.type.name)
            self._models[name] = make(vehicle, section, period, _seed_of(sensor, seed))
            self.deliveries[name] = Delivery(name, section, seed)
        self._encoders = EncoderSensor(vehicle.sensors.encoders, seed)
        self._seed = seed
        self._lines: dict[str, FaultLine] = {}  # of the sensors with faults
        self._joints: JointStates  # the newest that have come
        self._now = -1
        self._newest: dict[str, int] = {}

    def add_fault(self, event: SensorEvent) -> None:
        """Let a sensor fail."""
        self._lines.setdefault(event.sensor, FaultLine(self._seed)).add(event)

    def sample(self, trajectory: Trajectory, q: Array, q_dot: Array, effort: Array) -> SensorFrame:
        """Samples on a trajectory that is finite, and those of the encoders at its end."""
        before, self._now = self._now, trajectory.stamps[-1]
        samples = {
            name: self._deliver(name, checks.trust_all(model.sample(trajectory)))
            for name, model in self._models.items()
        }
        joints = self._deliver_joints(self._encoders.sample(self._now, q, q_dot, effort))
        return SensorFrame(samples, self._joints, joints, self._gaps(samples, joints, before))

    def _deliver_joints(self, sample: JointStates) -> tuple[JointStates, ...]:
        """What comes now of the joint states."""
        samples: tuple[JointStates, ...] = (checks.trust(sample),)
        if ENCODERS in self._lines:
            samples = self._lines[ENCODERS].pass_on(((self._now, sample),), self._now)
        if samples:
            self._joints = samples[-1]
        return samples

    def _deliver(self, name: str, samples: tuple[Any, ...]) -> tuple[Any, ...]:
        """What comes now of what a sensor has measured, with the faults that events give it."""
        delivery, line = self.deliveries[name], self._lines.get(name)
        if line is None:
            return delivery.deliver(samples, self._now)
        return line.pass_on(delivery.arrivals(samples, self._now), self._now)

    def _gaps(
        self,
        samples: Mapping[str, tuple[Any, ...]],
        joints: tuple[JointStates, ...],
        before: int,
    ) -> SensorGaps | None:
        """What is missing or late of the samples since the stamp before."""
        now, wrong = self._now, []
        for name, model in self._models.items():
            period, came = model.period, samples[name]
            due = now // period - before // period
            if came:
                self._newest[name] = came[-1].stamp
            if len(came) != due or (came and came[-1].stamp != now - now % period):
                wrong.append(name)
        self._newest[ENCODERS] = self._joints.stamp
        if len(joints) != 1 or joints[0].stamp != now:
            wrong.append(ENCODERS)
        if not wrong:
            return None
        newest = tuple(self._newest.get(name, NOTHING_YET) for name in wrong)
        return checks.trust(SensorGaps(now, tuple(wrong), newest))


def in_order_of_publication(vehicle: Vehicle) -> tuple[tuple[str, Topic], ...]:
    """Name and topic of each sensor; the inertial one comes last, since it starts the next tick."""
    order = sorted(mounted_sensors(vehicle), key=lambda sensor: sensor.type is INERTIAL)
    return tuple((sensor.name, sensor.topic) for sensor in order)


def _seed_of(sensor: MountedSensor, seed: int) -> int:
    """Of a sensor's model, whose random numbers go by its kind: two of a kind err apart."""
    if sensor.name == sensor.type.name:
        return seed
    return int(generator(seed, f"sensors/{sensor.name}").integers(2**31))
