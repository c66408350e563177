"""Definitions of installed message types: ros2msg schema text and type hash.

A type `package/msg/Name` is defined in `share/package/msg/Name.msg` of a ROS prefix; prefixes are
those of AMENT_PREFIX_PATH and the Python environment itself, into which the ROS wheels install.
The text for a log is the root definition, then, breadth first, each dependency after a line of 80
equals signs and `MSG: package/Name`, as rosbag2 has it. The messages of an action's hidden topics
are not supported: no file defines them, and readers reject their names because of the underscore.
"""

import json
import os
import sys
from collections import deque
from functools import cache
from pathlib import Path

from uvms_core.cdr.parse import parse_fields
from uvms_core.errors import DefinitionError

SEPARATOR = "=" * 80


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
        f"{package}/{kind}/{Path(file).stem} is not installed: source the ROS workspace that has"
        f" {package}; looked for {', '.join(str(path) for path in tried)}"
    )


def split_type(name: str) -> tuple[str, str, str]:
    """The parts of `package/kind/Name`."""
    parts = name.split("/")
    if len(parts) != 3 or not all(parts):
        raise DefinitionError(f"{name!r} is not a type name such as 'nav_msgs/msg/Odometry'")
    return parts[0], parts[1], parts[2]


def definition(name: str) -> str:
    """The definition of one type, without its dependencies."""
    package, kind, short = split_type(name)
    return _find(package, kind, f"{short}.msg").read_text(encoding="utf-8")


def _dependencies(package: str, text: str) -> list[str]:
    nested = [field.type for field in parse_fields(package, text) if not field.is_primitive]
    return ["{}/msg/{}".format(*short.split("/")) for short in nested]


@cache
def schema_text(name: str) -> str:
    """The ros2msg text of a type with all its dependencies, as a log stores it."""
    root = definition(name)
    texts = [root]
    seen = {name}
    queue = deque([(split_type(name)[0], root)])
    while queue:
        for other in _dependencies(*queue.popleft()):
            if other in seen:
                continue
            seen.add(other)
            package, _, short = split_type(other)
            text = definition(other)
            queue.append((package, text))
            texts.append(f"{SEPARATOR}\nMSG: {package}/{short}\n{text}")
    return "\n".join(text.rstrip("\n") for text in texts) + "\n"


@cache
def type_hash(name: str) -> str:
    """The REP-2016 hash (RIHS01_...) of an installed type, from its description file."""
    package, kind, short = split_type(name)
    path = _find(package, kind, f"{short}.json")
    for entry in json.loads(path.read_text(encoding="utf-8"))["type_hashes"]:
        if entry["type_name"] == name:
            return entry["hash_string"]
    raise DefinitionError(f"{path}: has no hash of {name}")
