"""What one topic or action is: name, type, signal, frame, quality of service, conversion."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

Kind = type
"""The class of a signal; `Topic` has a field named `type`."""

SENSORS = "sensors/"
"""What the names of the sensors' topics begin with; the sensor's own name follows."""
WORLD_FRAME = "map_ned"
BODY_FRAME = "base_link_fsd"


@dataclass(frozen=True)
class Qos:
    """Quality of service; every topic is reliable, so that a lockstep run is repeatable.

    The depth is generous because a writer that overruns its history loses samples even when
    reliable, and in lockstep the plant runs many times faster than the clock on the wall.
    """

    depth: int = 1000
    transient_local: bool = False


LATCHED = Qos(depth=1, transient_local=True)


@dataclass(frozen=True)
class Conversion:
    """Signal to message and back; both are called with topic, value and names.

    `names` are those of the vehicle's joints or thrusters, for messages that carry them.
    """

    to_message: Callable[[Any, Any, Sequence[str]], dict[str, Any]]
    from_message: Callable[[Any, Any, Sequence[str]], Any]


@dataclass(frozen=True)
class Topic:
    """One topic.

    Args:
        name: relative to the vehicle's namespace; global where it begins with a slash.
        type: of its messages, such as `sensor_msgs/msg/Imu`.
        signal: dataclass that it carries, None where it has none.
        frame: `frame_id` of its header.
        child_frame: its `child_frame_id`.
        qos: quality of service.
        conversion: of the signal, where `uvms_core.messages` does not know its class.
        is_occasional: whether it is published only when there is something to say, and may have
            no publisher at all.
        is_enu: whether a frame of the world that is neither map_ned nor map has east, north, up.
        sensor: of a sensor's samples, the name of its section in the vehicle file.
    """

    name: str
    type: str
    signal: Kind | None = None
    frame: str = ""
    child_frame: str = ""
    qos: Qos = Qos()
    conversion: Conversion | None = None
    is_occasional: bool = False
    is_enu: bool = False
    sensor: str = ""

    @property
    def is_global(self) -> bool:
        """Whether the name does not fall under the vehicle's namespace."""
        return self.name.startswith("/")

    def resolve(self, namespace: str = "") -> str:
        """The full name under a namespace ("" is the root)."""
        return self.name if self.is_global else _under(namespace, self.name)


@dataclass(frozen=True)
class Action:
    """An action of the planner; `goal` is the dataclass that its goal carries."""

    name: str
    type: str
    goal: Kind

    def resolve(self, namespace: str = "") -> str:
        """The full name under a namespace ("" is the root)."""
        return _under(namespace, self.name)


@dataclass(frozen=True)
class NodeTopics:
    """What the node of one name reads and writes, whoever wrote it."""

    inputs: tuple[Topic, ...]
    outputs: tuple[Topic, ...]
    actions: tuple[Action, ...] = ()  # that it serves


def _under(namespace: str, name: str) -> str:
    return "/" + "/".join(part for part in (namespace.strip("/"), name) if part)
