"""Node `disturbance_observer`: what acts on the vehicle besides its thrusters, eq. (21)."""

from uvms_core import topics
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode
from uvms_observer import ObserverConfig
from uvms_observer.parts import ObserverPart


class DisturbanceObserverNode(PartNode):
    """odometry, joint_states and wrench_achieved in; disturbance and disturbance/budget out."""

    role = topics.DISTURBANCE_OBSERVER
    configurations = (ObserverConfig,)

    def make_part(self) -> ObserverPart:
        """The observer that the parameters name."""
        return ObserverPart(self.vehicle, self.config(ObserverConfig), self.period)


def main(args=None) -> int:
    """`ros2 run uvms_observer disturbance_observer`."""
    return main_of(DisturbanceObserverNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
