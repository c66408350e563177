"""Node `thrust_allocator`: the commanded wrench as thrusts within their limits."""

from uvms_control import AllocationMethod, AllocatorConfig
from uvms_core import topics
from uvms_core.plugin import create
from uvms_core.ros.main import main_of
from uvms_core.ros.node import UvmsNode
from uvms_core.signals import Wrench
from uvms_core.tick_gate import Same, Tick


class ThrustAllocatorNode(UvmsNode):
    """wrench_command in; thruster_command, wrench_achieved and allocation out."""

    configurations = (AllocatorConfig,)

    def __init__(self, **options) -> None:
        super().__init__("thrust_allocator", **options)
        self._method: AllocationMethod = create(self.config(AllocatorConfig), self.vehicle)
        if warning := getattr(self._method, "warning", None):
            self.get_logger().warning(warning)
        self.connect({topics.WRENCH_COMMAND: Same()}, topics.WRENCH_COMMAND, self._step)

    def _step(self, tick: Tick) -> None:
        command, allocation = self._method.step(tick[topics.WRENCH_COMMAND.name])
        self.send(topics.THRUSTER_COMMAND, command)
        self.send(topics.WRENCH_ACHIEVED, Wrench(tick.stamp, allocation.achieved))
        self.send(topics.ALLOCATION, allocation)


def main(args=None) -> int:
    """`ros2 run uvms_control thrust_allocator`."""
    return main_of(ThrustAllocatorNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
