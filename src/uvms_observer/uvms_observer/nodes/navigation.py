"""Node `navigation`: the extended Kalman filter on the sensors' topics."""

from uvms_core import topics
from uvms_core.ros.main import main_of
from uvms_core.ros.node import UvmsNode
from uvms_core.sensors import INERTIAL, sensor_types
from uvms_core.signals import to_nanoseconds
from uvms_core.tick_gate import Periodic, Tick
from uvms_observer import NavigationConfig, NavigationFilter


class NavigationNode(UvmsNode):
    """sensors/* in, odometry out, once a control tick."""

    configurations = (NavigationConfig,)

    def __init__(self, **options) -> None:
        super().__init__("navigation", **options)
        self._filter = NavigationFilter(self.vehicle, self.config(NavigationConfig))
        used = [sensor for sensor in sensor_types(self.vehicle) if sensor.navigation]
        self._topics_by_sensor = {sensor.name: sensor.topic for sensor in used}
        sections = self.vehicle.sensors.mounted
        inputs = {sensor.topic: Periodic(period_of(sections[sensor.name])) for sensor in used}
        self.connect(inputs, INERTIAL.topic, self._step, every=self.period)

    def _step(self, tick: Tick) -> None:
        samples = {name: tick[topic.name] for name, topic in self._topics_by_sensor.items()}
        odometry, faults = self._filter.step_screened(tick.stamp, samples)
        self.refuse(tick.stamp, faults)
        self.send(topics.ODOMETRY, odometry)
        self.report_each_second(tick.stamp, **self._filter.status())


def period_of(sensor) -> int:
    """Nanoseconds between two samples of a sensor of the vehicle file."""
    return to_nanoseconds(1.0 / sensor.rate_hz)


def main(args=None) -> int:
    """`ros2 run uvms_observer navigation`."""
    return main_of(NavigationNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
