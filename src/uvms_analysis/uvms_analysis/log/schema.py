"""Description of a channel in a log: definition and hash of its type, quality of service."""

import yaml

from uvms_core.cdr import DefinitionError, schema_text, type_hash
from uvms_core.topics import Qos

ENCODING = "ros2msg"
MESSAGE_ENCODING = "cdr"
PROFILE = "ros2"

_INFINITE = {"sec": 9223372036, "nsec": 854775807}
"""Durations that rmw takes as "never"."""


def qos_yaml(qos: Qos) -> str:
    """Quality of service as rosbag2 writes it (all nine keys, policies by name)."""
    profile = {
        "history": "keep_last",
        "depth": qos.depth,
        "reliability": "reliable",
        "durability": "transient_local" if qos.transient_local else "volatile",
        "deadline": _INFINITE,
        "lifespan": _INFINITE,
        "liveliness": "automatic",
        "liveliness_lease_duration": _INFINITE,
        "avoid_ros_namespace_conventions": False,
    }
    return yaml.dump([profile], Dumper=_NoAliases, sort_keys=False)


def qos_from_yaml(text: str) -> Qos:
    """Depth and durability back from a log's channel; the first profile counts."""
    profiles = yaml.safe_load(text) if text else None
    if not profiles:
        return Qos()
    first = profiles[0]
    latched = str(first.get("durability")) in ("transient_local", "1")
    return Qos(max(int(first.get("depth", 1)), 1), latched)


class _NoAliases(yaml.SafeDumper):
    def ignore_aliases(self, data: object) -> bool:
        return True


def channel_metadata(type_name: str, qos: str) -> dict[str, str]:
    """Metadata of a channel in the format of rosbag2; a type without a hash gets an empty one."""
    try:
        hash_text = type_hash(type_name)
    except DefinitionError:
        hash_text = ""
    return {"offered_qos_profiles": qos, "topic_type_hash": hash_text}


__all__ = ["channel_metadata", "qos_from_yaml", "qos_yaml", "schema_text", "type_hash"]
