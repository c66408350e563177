"""Which topics of a log the filter takes for which sensors of the vehicle."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from uvms_bringup.errors import BringupError
from uvms_bringup.navigate.bag import Bag
from uvms_core import registry, topics
from uvms_core.errors import PluginError
from uvms_core.sensors import INERTIAL, MountedSensor, sensor_type
from uvms_core.vehicle import Vehicle
from uvms_core.yaml_text import read_yaml
from uvms_observer.arrivals import used_sensors

REFERENCE = "reference"
"""Key of the topic that the estimate is compared with."""
REFERENCE_TYPES = ("nav_msgs/msg/Odometry", "geometry_msgs/msg/PoseStamped")
NONE = "none"
"""In the place of a topic: leave this one out."""


class TopicMapError(BringupError):
    """A topic that is asked for is not there, or nothing says which one is meant."""


@dataclass
class TopicMap:
    """Full names of the log's topics.

    Attributes:
        sensors: topic of each sensor that the log has, by the sensor's name.
        reference: topic of the reference; None without one.
        notes: what was guessed, and what was left out.
        left_out: why there is no topic for a sensor, by its name.
    """

    sensors: dict[str, str] = field(default_factory=dict)
    reference: str | None = None
    notes: list[str] = field(default_factory=list)
    left_out: dict[str, str] = field(default_factory=dict)


def given_topics(words: Sequence[str]) -> dict[str, str]:
    """Topics by key, from `key=topic` and from YAML files with the same as a mapping.

    Raises:
        TopicMapError: a word is neither, or a file is no such mapping.
    """
    found: dict[str, str] = {}
    for word in words:
        key, equals, topic = word.partition("=")
        if equals:
            found[key.strip()] = topic.strip()
            continue
        values = read_yaml(Path(word), word, TopicMapError)
        if not isinstance(values, Mapping) or not all(isinstance(v, str) for v in values.values()):
            raise TopicMapError(f"{word}: must map names of sensors to topics, as `imu: /imu/data`")
        found |= {str(key): topic for key, topic in values.items()}
    return found


def topic_map(bag: Bag, vehicle: Vehicle, given: Mapping[str, str]) -> TopicMap:
    """The topics that were given, and for the rest those that the types leave no doubt about.

    Raises:
        TopicMapError: a given key or topic is unknown or of another type, or it is not clear which
            topic is the inertial unit's.
    """
    sensors = {sensor.name: sensor for sensor in used_sensors(vehicle)}
    _check_keys(given, sensors)
    found, chosen = TopicMap(), dict[str, str]()
    for name in given.keys() & sensors.keys():
        if (topic := _given(bag, name, (sensors[name].topic.type,), given)) is not None:
            chosen[name] = topic
    found.reference = _given(bag, REFERENCE, REFERENCE_TYPES, given)
    for name in [name for name in sensors if name not in given]:
        taken = {*chosen.values(), found.reference}
        waiting = [sensors[each] for each in sensors if each not in chosen and each not in given]
        if (topic := _guess(found, bag, sensors[name], waiting, taken)) is not None:
            chosen[name] = topic
    found.sensors = {name: chosen[name] for name in sensors if name in chosen}
    _require_unit(bag, found)
    if REFERENCE not in given:
        found.reference = _guess_reference(found, bag)
    found.notes += _unused(bag, found, sensors.values())
    return found


def _check_keys(given: Mapping[str, str], sensors: Mapping[str, MountedSensor]) -> None:
    for key in given:
        if key not in sensors and key != REFERENCE:
            raise TopicMapError(
                f"--topics {key}={given[key]}: the vehicle's file has no sensor {key!r} that"
                f" navigation uses; choose one of {', '.join(sensors)}, or {REFERENCE}"
            )


def _given(bag: Bag, key: str, types: Sequence[str], given: Mapping[str, str]) -> str | None:
    topic = given.get(key)
    if topic is None or topic == NONE:
        return None
    full = topic if topic.startswith("/") else f"/{topic}"
    if bag.types.get(full) in types:
        return full
    fits = ", ".join(bag.of_type(*types)) or "none"
    what = f"is {bag.types[full]}" if full in bag.types else "is not in the log"
    raise TopicMapError(
        f"--topics {key}={topic}: {what}; {key} must be {' or '.join(types)}, and of these"
        f" {bag.path} has {fits}"
    )


def _guess(
    found: TopicMap,
    bag: Bag,
    sensor: MountedSensor,
    waiting: Sequence[MountedSensor],
    taken: Collection[str | None],
) -> str | None:
    """The only topic of the type that nothing else is; our own name goes before."""
    topic, key = sensor.topic, sensor.name
    fits = [name for name in bag.of_type(topic.type) if name not in taken]
    own = [name for name in fits if name.endswith(topic.resolve())]
    if len(own) == 1:
        return own[0]
    rivals = [other.name for other in waiting if _may_be_meant(other, sensor)]
    if len(fits) == 1 and not rivals:
        found.notes.append(f"{key}: {fits[0]}, the only {topic.type}{_left(bag, topic.type)}")
        return fits[0]
    if key != INERTIAL.name and not bag.is_ours:
        found.left_out[key] = f"{key}: left out, since {_why_none(bag, sensor, fits, rivals)}"
        found.notes.append(found.left_out[key])
    return None


def _may_be_meant(other: MountedSensor, sensor: MountedSensor) -> bool:
    """Whether a topic that this sensor could have may as well be that of the other one.

    The inertial unit goes first, and of two of a kind that which has the name of its kind.
    """
    if other is sensor or other.topic.type != sensor.topic.type or sensor.name == INERTIAL.name:
        return False
    return not (other.type is sensor.type and sensor.name == sensor.type.name)


def _left(bag: Bag, type_name: str) -> str:
    return "" if len(bag.of_type(type_name)) == 1 else " that is left"


def _why_none(bag: Bag, sensor: MountedSensor, fits: Sequence[str], rivals: Sequence[str]) -> str:
    """Why there is no topic for this sensor."""
    kind = sensor.topic.type
    if not fits:
        further = " besides those of other sensors" if bag.of_type(kind) else ""
        return f"the log has no {kind}{further}"
    choose = f"choose one by --topics {sensor.name}={fits[0]}"
    if len(fits) > 1:
        return f"the log has several {kind}: {', '.join(fits)}; {choose}"
    return f"{fits[0]} may as well be that of {' or '.join(rivals)}; {choose}"


def _require_unit(bag: Bag, found: TopicMap) -> None:
    key = INERTIAL.name
    if key in found.sensors:
        return
    fits = bag.of_type(INERTIAL.message)
    if fits:
        raise TopicMapError(
            f"log {bag.path}: which of {', '.join(fits)} is the inertial unit? Choose one by"
            f" --topics {key}={fits[0]}"
        )
    known = ", ".join(f"{name} [{one}]" for name, one in sorted(bag.types.items())) or "nothing"
    raise TopicMapError(
        f"log {bag.path}: has no {INERTIAL.message}, which navigation needs; it has {known}"
    )


def _guess_reference(found: TopicMap, bag: Bag) -> str | None:
    fits = bag.of_type(*REFERENCE_TYPES)
    true = [name for name in fits if name.endswith(f"/{topics.TRUE_ODOMETRY.name}")]
    if len(true) == 1:
        return true[0]
    if len(fits) == 1:
        found.notes.append(f"{REFERENCE}: {fits[0]}, the only {bag.types[fits[0]]}")
        return fits[0]
    if fits:
        found.notes.append(
            f"{REFERENCE}: none, since the log has several poses: {', '.join(fits)}; choose one by"
            f" --topics {REFERENCE}={fits[0]}"
        )
    return None


def _unused(bag: Bag, found: TopicMap, sensors: Iterable[MountedSensor]) -> list[str]:
    """Topics with measurements that this vehicle has no sensor for."""
    known = {sensor.topic.type for sensor in sensors}
    further = sorted(_measured_types() - known)
    return [
        f"{topic}: not used, since the vehicle's file has no sensor with {bag.types[topic]}"
        for topic in bag.of_type(*further)
        if topic != found.reference
    ]


def _measured_types() -> set[str]:
    """Types of the messages of all kinds of sensors that navigation may use."""
    found = set()
    for name in registry.names(registry.SENSORS):
        try:
            kind = sensor_type(name)
        except PluginError:  # of somebody else's package
            continue
        if kind.navigation:
            found.add(kind.message)
    return found
