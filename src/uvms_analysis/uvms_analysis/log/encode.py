"""Write signals to a log without ROS, as the graph would publish them."""

from collections.abc import Callable, Sequence
from typing import Any

from uvms_analysis.log.schema import qos_yaml
from uvms_analysis.log.writer import LogWriter
from uvms_core.cdr import Codec, codec
from uvms_core.messages import to_message
from uvms_core.signals import BY_THRUSTER
from uvms_core.topics import CLOCK, Topic


class SignalWriter:
    """Writes signals under a namespace, with the names of the vehicle's joints and thrusters."""

    def __init__(
        self,
        log: LogWriter,
        joint_names: Sequence[str],
        thruster_names: Sequence[str],
        namespace: str = "",
    ) -> None:
        self._log = log
        self._joint_names = tuple(joint_names)
        self._thruster_names = tuple(thruster_names)
        self._namespace = namespace
        self._channels: dict[str, tuple[str, str, Codec]] = {}

    def write(self, topic: Topic, signal: Any, stamp: int | None = None) -> None:
        """One signal at its own stamp, or at the one given."""
        if stamp is None:
            stamp = signal if topic is CLOCK else signal.stamp
        self.write_plain(topic, to_message(topic, signal, self._names(signal)), stamp)

    def write_plain(self, topic: Topic, message: dict[str, Any], stamp: int) -> None:
        """One message given as a nested dict, such as a static transform."""
        channel = self._channels.get(topic.name)
        if channel is None:
            channel = topic.resolve(self._namespace), qos_yaml(topic.qos), codec(topic.type)
            self._channels[topic.name] = channel
        self._log.write(channel[0], topic.type, channel[1], stamp, channel[2].encode(message))

    def write_made(self, topic: Topic, stamp: int, make: Callable[..., Any], *values: Any) -> None:
        """The message that `make` makes of the values: no other writer need make it."""
        self.write_plain(topic, make(*values), stamp)

    def _names(self, signal: Any) -> tuple[str, ...]:
        thrusters = isinstance(signal, BY_THRUSTER)
        return self._thruster_names if thrusters else self._joint_names
