"""Node `navigation`: the extended Kalman filter on the sensors' topics."""

from uvms_core import topics
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode
from uvms_observer import NavigationConfig
from uvms_observer.parts import NavigationPart


class NavigationNode(PartNode):
    """sensors/* in, odometry out, once a control tick."""

    role = topics.NAVIGATION
    configurations = (NavigationConfig,)

    def make_part(self) -> NavigationPart:
        """The navigation filter that the parameters name."""
        return NavigationPart(self.vehicle, self.config(NavigationConfig), self.period)


def main(args=None) -> int:
    """`ros2 run uvms_observer navigation`."""
    return main_of(NavigationNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
