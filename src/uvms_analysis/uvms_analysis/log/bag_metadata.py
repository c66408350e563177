"""`metadata.yaml` beside a log: with it `ros2 bag info DIR` and rosbags take the folder for a bag.

A folder is the bag of one log, of the first that was finished in it: a replay beside its run leaves
the run's file alone. Other files in the folder (config.yaml, summary.json) do not disturb readers.
"""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from uvms_analysis.errors import LogError
from uvms_core.yaml_text import dump_yaml

NAME = "metadata.yaml"
VERSION = 9
"""Of the file's format, as ROS 2 Jazzy writes it."""
ROOT = "rosbag2_bagfile_information"


@dataclass(frozen=True)
class BagTopic:
    """A channel: full name, type, number of messages, and its metadata in the log."""

    name: str
    type: str
    count: int
    metadata: Mapping[str, str]


@dataclass(frozen=True)
class Bag:
    """Times in ns and topics of a log."""

    start: int
    duration: int
    topics: Sequence[BagTopic]


def write_bag_metadata(log: Path, bag: Bag) -> None:
    """Write the file, unless the folder is another log's.

    Raises:
        LogError: it cannot be written.
    """
    path = log.parent / NAME
    if _of_another(path, log.name):
        return
    part = path.with_suffix(".part")
    try:
        part.write_text(dump_yaml({ROOT: _content(log.name, bag)}), encoding="utf-8")
        os.replace(part, path)
    except OSError as fault:
        part.unlink(missing_ok=True)
        raise LogError(f"{path}: cannot be written: {fault.strerror}") from fault


def _of_another(path: Path, name: str) -> bool:
    """Whether the file exists and describes a log that is still beside it."""
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
        files = [str(file) for file in content[ROOT]["relative_file_paths"]]
    except FileNotFoundError:
        return False
    except (OSError, ValueError, yaml.YAMLError, KeyError, TypeError):
        return False
    return name not in files and any((path.parent / file).exists() for file in files)


def _content(name: str, bag: Bag) -> dict[str, Any]:
    return {
        "version": VERSION,
        "storage_identifier": "mcap",
        **_span(bag),
        "topics_with_message_count": [_topic(topic) for topic in bag.topics],
        "compression_format": "",
        "compression_mode": "",
        "relative_file_paths": [name],
        "files": [{"path": name, **_span(bag)}],
        "custom_data": None,
        "ros_distro": "jazzy",
    }


def _span(bag: Bag) -> dict[str, Any]:
    return {
        "duration": {"nanoseconds": bag.duration},
        "starting_time": {"nanoseconds_since_epoch": bag.start},
        "message_count": sum(topic.count for topic in bag.topics),
    }


def _topic(topic: BagTopic) -> dict[str, Any]:
    profiles = topic.metadata.get("offered_qos_profiles", "")
    return {
        "topic_metadata": {
            "name": topic.name,
            "type": topic.type,
            "serialization_format": "cdr",
            "offered_qos_profiles": _profiles(profiles),
            "type_description_hash": topic.metadata.get("topic_type_hash", ""),
        },
        "message_count": topic.count,
    }


def _profiles(text: str) -> list[Any]:
    try:
        return list(yaml.safe_load(text) or [])
    except (yaml.YAMLError, TypeError):  # of a foreign log that was recovered
        return []
