"""Definitions of installed message types: ros2msg schema text and type hash.

A type `package/msg/Name` is defined in `share/package/msg/Name.msg` of a ROS prefix; prefixes are
those of AMENT_PREFIX_PATH and the Python environment itself, into which the ROS wheels install.
The text for a log is the root definition, then, breadth first, each dependency after a line of 80
equals signs and `MSG: package/Name`, as rosbag2 has it. Messages of actions exist in no file:
feedback messages are made here from the action's own definition (rosbag2 of Jazzy leaves their
definition empty).
"""

import json
import os
import sys
from collections import deque
from functools import cache
from pathlib import Path

from uvms_dynamics.cdr.errors import DefinitionError
from uvms_dynamics.cdr.parse import parse_fields

SEPARATOR = "=" * 80
FEEDBACK_MESSAGE = "_FeedbackMessage"
FEEDBACK = "_Feedback"


def prefixes() -> tuple[Path, ...]:
    """ROS prefixes in the order of search."""
    paths = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return tuple(dict.fromkeys(Path(path) for path in [*paths, sys.prefix] if path))


def _find(package: str, kind: str, file: str) -> Path:
    tried = [prefix / "share" / package / kind / file for prefix in prefixes()]
    for path in tried:
        if path.is_file():
            return path
    raise DefinitionError(
        f"{package}/{kind}/{Path(file).stem} is not installed; looked for "
        + ", ".join(str(path) for path in tried)
    )


def split_type(name: str) -> tuple[str, str, str]:
    """`package/kind/Name` in its parts."""
    parts = name.split("/")
    if len(parts) != 3 or not all(parts):
        raise DefinitionError(f"{name!r} is not a type name such as 'nav_msgs/msg/Odometry'")
    return parts[0], parts[1], parts[2]


def definition(name: str) -> str:
    """The definition of one type, without its dependencies."""
    package, kind, short = split_type(name)
    if kind != "action":
        return _find(package, kind, f"{short}.msg").read_text(encoding="utf-8")
    if short.endswith(FEEDBACK_MESSAGE):
        feedback = short.removesuffix(FEEDBACK_MESSAGE) + FEEDBACK
        return f"unique_identifier_msgs/UUID goal_id\n{package}/{feedback} feedback\n"
    if short.endswith(FEEDBACK):
        file = _find(package, "action", f"{short.removesuffix(FEEDBACK)}.action")
        return _third_part(file.read_text(encoding="utf-8"))
    raise DefinitionError(f"{name} is no message; of actions there is *{FEEDBACK_MESSAGE}")


def _third_part(text: str) -> str:
    """Feedback of an action file: what follows its second line of three dashes."""
    lines = text.splitlines()
    marks = [index for index, line in enumerate(lines) if line.strip() == "---"]
    return "\n".join(lines[marks[1] + 1 :]) + "\n"


def _dependencies(name: str, text: str) -> list[str]:
    package, kind, _ = split_type(name)
    types = [field.type for field in parse_fields(package, text) if not field.is_primitive]
    return [
        _full(other, "action" if _is_own_feedback(other, package, kind) else "msg")
        for other in types
    ]


def _is_own_feedback(other: str, package: str, kind: str) -> bool:
    return kind == "action" and other.startswith(f"{package}/") and other.endswith(FEEDBACK)


def _full(short: str, kind: str) -> str:
    package, name = short.split("/")
    return f"{package}/{kind}/{name}"


@cache
def schema_text(name: str) -> str:
    """The ros2msg text of a type with all its dependencies, as a log stores it."""
    texts = [definition(name)]
    seen = {name}
    queue = deque([(name, texts[0])])
    while queue:
        for other in _dependencies(*queue.popleft()):
            if other in seen:
                continue
            seen.add(other)
            text = definition(other)
            queue.append((other, text))
            package, _, short = split_type(other)
            texts.append(f"{SEPARATOR}\nMSG: {package}/{short}\n{text}")
    return "\n".join(text.rstrip("\n") for text in texts) + "\n"


@cache
def type_hash(name: str) -> str:
    """The REP-2016 hash (RIHS01_...) of an installed type, from its description file."""
    package, kind, short = split_type(name)
    stem = short.split("_")[0] if kind == "action" else short
    path = _find(package, kind, f"{stem}.json")
    for entry in json.loads(path.read_text(encoding="utf-8"))["type_hashes"]:
        if entry["type_name"] == name:
            return entry["hash_string"]
    raise DefinitionError(f"{path}: has no hash of {name}")
