"""Node `thrust_allocator`: the commanded wrench as thrusts within their limits."""

from collections.abc import Sequence
from typing import Any

from uvms_control import AllocatorConfig
from uvms_control.errors import ControlSetupError
from uvms_control.parts import AllocatorPart
from uvms_core import topics
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode
from uvms_msgs.msg import ThrusterHealth
from uvms_msgs.srv import SetThrusterHealth

LATEST = 10
"""Messages of users that wait."""


class ThrustAllocatorNode(PartNode):
    """wrench_command in; thruster_command, wrench_achieved and allocation out.

    Users who know of a weak thruster say so by the service `set_thruster_health` or on the topic
    `thruster_health`.
    """

    role = topics.THRUST_ALLOCATOR
    configurations = (AllocatorConfig,)
    part: AllocatorPart

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.create_service(SetThrusterHealth, "set_thruster_health", self._answer_health)
        self.create_subscription(ThrusterHealth, "thruster_health", self._take_health, LATEST)

    def make_part(self) -> AllocatorPart:
        """The allocation method that the parameters name."""
        part = AllocatorPart(self.vehicle, self.config(AllocatorConfig), self.period)
        if warning := getattr(part.method, "warning", None):
            self.get_logger().warning(warning)
        return part

    def _answer_health(
        self, request: SetThrusterHealth.Request, response: SetThrusterHealth.Response
    ) -> SetThrusterHealth.Response:
        thrusters = self.part.thrusters
        try:
            self._say(request.thruster_names, request.effectiveness)
            response.success, response.message = True, thrusters.summary
        except ControlSetupError as fault:
            response.success, response.message = False, str(fault)
        response.all_thruster_names = list(thrusters.belief.names)
        response.believed = thrusters.belief.effectiveness.tolist()
        response.authority = thrusters.authority.tolist()
        return response

    def _take_health(self, message: ThrusterHealth) -> None:
        self.guard(lambda: self._say(message.thruster_names, message.effectiveness))

    def _say(self, names: Sequence[str], shares: Sequence[float]) -> None:
        self.get_logger().info(self.part.thrusters.say(_by_name(names, shares)))


def _by_name(names: Sequence[str], shares: Sequence[float]) -> dict[str, float]:
    if len(names) != len(shares) or len(set(names)) != len(names):
        raise ControlSetupError(
            f"thruster health: {len(names)} names and {len(shares)} shares; give one share for each"
            " name, and each name once"
        )
    return dict(zip(names, shares, strict=True))


def main(args=None) -> int:
    """`ros2 run uvms_control thrust_allocator`."""
    return main_of(ThrustAllocatorNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
