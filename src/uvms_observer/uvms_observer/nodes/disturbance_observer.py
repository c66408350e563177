"""Node `disturbance_observer`: what acts on the vehicle besides its thrusters, eq. (21)."""

from uvms_core import topics
from uvms_core.plugin import create
from uvms_core.ros.main import main_of
from uvms_core.ros.node import UvmsNode
from uvms_core.tick_gate import Previous, Same, Tick
from uvms_observer import ObserverConfig, ObserverLaw


class DisturbanceObserverNode(UvmsNode):
    """odometry, joint_states and wrench_achieved in; disturbance and disturbance/budget out."""

    configurations = (ObserverConfig,)

    def __init__(self, **options) -> None:
        super().__init__("disturbance_observer", **options)
        self._observer: ObserverLaw = create(self.config(ObserverConfig), self.vehicle)
        inputs = {
            topics.ODOMETRY: Same(),
            topics.JOINT_STATES: Same(),
            topics.WRENCH_ACHIEVED: Previous(self.period),
        }
        self.connect(inputs, topics.ODOMETRY, self._step)

    def _step(self, tick: Tick) -> None:
        budget, total = self._observer.step(
            tick[topics.ODOMETRY.name],
            tick[topics.JOINT_STATES.name],
            tick[topics.WRENCH_ACHIEVED.name],
        )
        self.send(topics.DISTURBANCE, total)
        self.send(topics.DISTURBANCE_BUDGET, budget)


def main(args=None) -> int:
    """`ros2 run uvms_observer disturbance_observer`."""
    return main_of(DisturbanceObserverNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
