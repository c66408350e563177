"""Navigation filter and disturbance observer as parts of the loop."""

from collections.abc import Iterator, Sequence

from uvms_core import topics
from uvms_core.errors import UvmsError
from uvms_core.part import Output, Part
from uvms_core.plugin import create
from uvms_core.sensors import INERTIAL, sensor_types
from uvms_core.signals import to_nanoseconds
from uvms_core.tick_gate import Periodic, Previous, Same, Tick
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Sensor
from uvms_observer.disturbance import ObserverConfig
from uvms_observer.interfaces import NavigationEstimator, ObserverLaw
from uvms_observer.navigation import NavigationConfig


class NavigationPart(Part):
    """Samples of all sensors in, odometry out, once a control tick.

    Args:
        vehicle: its sensors.
        config: of the filter.
        period: of the control loop, ns.
    """

    trigger = INERTIAL.topic
    outputs = topics.NODES[topics.NAVIGATION].outputs

    def __init__(self, vehicle: Vehicle, config: NavigationConfig, period: int) -> None:
        self.filter: NavigationEstimator = create(config, vehicle)
        self.every = period
        used = [sensor for sensor in sensor_types(vehicle) if sensor.navigation]
        sections = vehicle.sensors.mounted
        self._sensors = {sensor.name: sensor.topic.name for sensor in used}
        self.inputs = {
            sensor.topic: Periodic(sample_period(sections[sensor.name])) for sensor in used
        }
        self._faults: Sequence[UvmsError] = ()

    def step(self, tick: Tick) -> Iterator[Output]:
        """One step of the filter; samples that it refuses are left out."""
        samples = {name: tick[topic] for name, topic in self._sensors.items()}
        odometry, self._faults = self.filter.step_screened(tick.stamp, samples)
        yield topics.ODOMETRY, odometry

    def take_faults(self) -> Sequence[UvmsError]:
        """Samples that the last step left out."""
        faults, self._faults = self._faults, ()
        return faults

    def status(self) -> dict[str, int | float]:
        """Counters and uncertainty of the filter."""
        return self.filter.status()


def sample_period(sensor: Sensor) -> int:
    """Nanoseconds between two samples of a sensor."""
    return to_nanoseconds(1.0 / sensor.rate_hz)


class ObserverPart(Part):
    """Estimated state and achieved wrench in; disturbance and its budget out, eq. (21)."""

    trigger = topics.ODOMETRY
    outputs = topics.NODES[topics.DISTURBANCE_OBSERVER].outputs

    def __init__(self, vehicle: Vehicle, config: ObserverConfig, period: int) -> None:
        self.law: ObserverLaw = create(config, vehicle)
        self.inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Same(),
            topics.WRENCH_ACHIEVED: Previous(period),
        }

    def step(self, tick: Tick) -> Iterator[Output]:
        """One step of the observer."""
        budget, total = self.law.step(
            tick[topics.ODOMETRY.name],
            tick[topics.JOINT_STATES.name],
            tick[topics.WRENCH_ACHIEVED.name],
        )
        yield topics.DISTURBANCE, total
        yield topics.DISTURBANCE_BUDGET, budget
