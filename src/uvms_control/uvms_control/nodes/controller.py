"""Node `controller`: S-surface plus dynamic law for the vehicle, S-surface law for the arm."""

from uvms_control import ControlConfig, ControlLaw
from uvms_core import topics
from uvms_core.plugin import create
from uvms_core.ros.main import main_of
from uvms_core.ros.node import UvmsNode
from uvms_core.tick_gate import Covering, Same, Tick


class ControllerNode(UvmsNode):
    """odometry, joint_states, reference and disturbance in; wrench and joint command out."""

    configurations = (ControlConfig,)

    def __init__(self, **options) -> None:
        super().__init__("controller", **options)
        self._law: ControlLaw = create(self.config(ControlConfig), self.vehicle)
        inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Same(),
            topics.DISTURBANCE: Same(),
            topics.REFERENCE: Covering(),
        }
        self.connect(inputs, topics.ODOMETRY, self._step)

    def _step(self, tick: Tick) -> None:
        wrench, joints = self._law.step(
            tick[topics.ODOMETRY.name],
            tick[topics.JOINT_STATES.name],
            tick[topics.DISTURBANCE.name],
            tick[topics.REFERENCE.name],
        )
        self.send(topics.WRENCH_COMMAND, wrench)
        self.send(topics.JOINT_COMMAND, joints)


def main(args=None) -> int:
    """`ros2 run uvms_control controller`."""
    return main_of(ControllerNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
