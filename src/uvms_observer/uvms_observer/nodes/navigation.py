"""Node `navigation`: the extended Kalman filter on the sensors' topics."""

from uvms_core import topics
from uvms_core.plugin import create
from uvms_core.ros.main import main_of
from uvms_core.ros.node import UvmsNode
from uvms_core.signals import to_nanoseconds
from uvms_core.tick_gate import Periodic, Tick
from uvms_observer import NavigationConfig, NavigationEstimator


class NavigationNode(UvmsNode):
    """sensors/* in, odometry out, once a control tick."""

    configurations = (NavigationConfig,)

    def __init__(self, **options) -> None:
        super().__init__("navigation", **options)
        self._filter: NavigationEstimator = create(self.config(NavigationConfig), self.vehicle)
        sensors = self.vehicle.sensors
        inputs = {
            topics.IMU: Periodic(period_of(sensors.imu)),
            topics.DVL: Periodic(period_of(sensors.dvl)),
            topics.PRESSURE: Periodic(period_of(sensors.pressure)),
            topics.GPS: Periodic(period_of(sensors.gps)),
        }
        self.connect(inputs, topics.IMU, self._step, every=self.period)

    def _step(self, tick: Tick) -> None:
        sensors = (topics.IMU, topics.DVL, topics.PRESSURE, topics.GPS)
        good, faults = zip(
            *(self._filter.screen(tick.stamp, tick[topic.name]) for topic in sensors), strict=True
        )
        self.refuse(tick.stamp, [fault for some in faults for fault in some])
        self.send(topics.ODOMETRY, self._filter.step(tick.stamp, *good))
        self.report_each_second(tick.stamp, **self._filter.status())


def period_of(sensor) -> int:
    """Nanoseconds between two samples of a sensor of the vehicle file."""
    return to_nanoseconds(1.0 / sensor.rate_hz)


def main(args=None) -> int:
    """`ros2 run uvms_observer navigation`."""
    return main_of(NavigationNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
