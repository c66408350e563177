"""Publishes a node's recorded inputs, tick by tick, and takes its outputs."""

from collections import Counter, defaultdict

from rclpy.node import Node
from rclpy.task import Future

from uvms_analysis.log.read import RunLog
from uvms_analysis.log.schema import qos_yaml
from uvms_analysis.log.writer import LogWriter
from uvms_bringup.ros.recorder import stamp_of
from uvms_bringup.ros.schedule import TickOf, TickRecord
from uvms_core import topics
from uvms_core.ros.convert import message_class
from uvms_core.ros.roll_call import RollCall
from uvms_core.ros.subscribe import qos_profile


class InputPlayer(Node):
    """Publishes a node's recorded inputs and takes its outputs."""

    def __init__(
        self, run: RunLog, node: str, own: topics.NodeTopics, tick_of: TickOf, log: LogWriter
    ) -> None:
        super().__init__("input_player", namespace=run.namespace)
        self._tick_of, self._log = tick_of, log
        self._arrived: dict[int, Counter[str]] = defaultdict(Counter)
        self._pending: TickRecord | None = None
        self._answered = Future()
        self._inputs = {
            topic.resolve(run.namespace): self.create_publisher(
                message_class(topic), topic.name, qos_profile(topic.qos)
            )
            for topic in own.inputs
        }
        self._outputs = [self._listen(run, topic) for topic in own.outputs]
        self._roll_call = RollCall(self, (node,))
        self.lack = ""

    def _listen(self, run: RunLog, topic: topics.Topic):
        name, qos = topic.resolve(run.namespace), qos_yaml(topic.qos)

        def take(data: bytes) -> None:
            stamp = stamp_of(data)
            self._log.write(name, topic.type, qos, stamp, data)
            self._arrived[self._tick_of(name, stamp)][name] += 1
            self._check_answer()

        return self.create_subscription(
            message_class(topic), topic.name, take, qos_profile(topic.qos), raw=True
        )

    def connected(self) -> bool:
        """Whether the node and the player are connected in both directions."""
        self.lack = "; ".join(self._roll_call.poll().values())
        return not self.lack and self._matched()

    def _matched(self) -> bool:
        self.lack = "topics are not yet connected"
        read = all(
            publisher.get_subscription_count()
            for name, publisher in self._inputs.items()
            if name != topics.CLOCK.name  # which a node reads only if it uses simulation time
        )
        return read and all(one.get_publisher_count() for one in self._outputs)

    def play(self, tick: TickRecord) -> None:
        """Publish the inputs of a tick."""
        for name, data in tick.inputs:
            self._inputs[name].publish(data)

    def answer_to(self, tick: TickRecord) -> Future:
        """Done when all outputs that the tick had in the recorded run have arrived."""
        self._pending, self._answered = tick, Future()
        self._check_answer()
        return self._answered

    def _check_answer(self) -> None:
        tick = self._pending
        if tick is not None and self._arrived[tick.stamp] >= tick.outputs:
            self._pending = None
            self._arrived = defaultdict(
                Counter, {stamp: n for stamp, n in self._arrived.items() if stamp > tick.stamp}
            )
            self._answered.set_result(True)
