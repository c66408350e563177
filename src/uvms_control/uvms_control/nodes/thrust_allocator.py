"""Node `thrust_allocator`: the commanded wrench as thrusts within their limits."""

from uvms_control import AllocatorConfig
from uvms_control.parts import AllocatorPart
from uvms_core import topics
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode


class ThrustAllocatorNode(PartNode):
    """wrench_command in; thruster_command, wrench_achieved and allocation out."""

    role = topics.THRUST_ALLOCATOR
    configurations = (AllocatorConfig,)

    def make_part(self) -> AllocatorPart:
        """The allocation method that the parameters name."""
        part = AllocatorPart(self.vehicle, self.config(AllocatorConfig), self.period)
        if warning := getattr(part.method, "warning", None):
            self.get_logger().warning(warning)
        return part


def main(args=None) -> int:
    """`ros2 run uvms_control thrust_allocator`."""
    return main_of(ThrustAllocatorNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
