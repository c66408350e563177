"""Node `controller`: wrench for the vehicle and torques for the joints, by the law it is given."""

from uvms_control import ControlConfig
from uvms_control.parts import ControllerPart
from uvms_core import topics
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode


class ControllerNode(PartNode):
    """odometry, joint_states, reference and disturbance in; wrench and joint command out."""

    role = topics.CONTROLLER
    configurations = (ControlConfig,)

    def make_part(self) -> ControllerPart:
        """The control law that the parameters name."""
        return ControllerPart(self.vehicle, self.config(ControlConfig), self.period)


def main(args=None) -> int:
    """`ros2 run uvms_control controller`."""
    return main_of(ControllerNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
