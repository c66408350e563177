"""Reads and writes the YAML of vehicle files, scenarios and `--set PATH=VALUE`.

The reader is ruamel.yaml, because it follows YAML 1.2: `1e-3` is a number, `012` is twelve, `on`
and `yes` are text, and a key that is given twice is an error. The writer is PyYAML, because ROS
reads parameter files as YAML 1.1; text that either version would take for a number is quoted, so
that both read the same values. The reader in pure Python takes 55 ms for a vehicle file of 200
lines.
"""

import re
from pathlib import Path
from typing import Any

import yaml

from uvms_core.errors import UvmsError

MAX_VALUES = 100_000
"""Values in a file at most, each alias counted with all that it stands for."""

_DUPLICATE = re.compile(r'found duplicate key "(.*?)" with value', re.DOTALL)


def parse_yaml(text: str, what: str, error: type[UvmsError]) -> Any:
    """The data of a YAML text; `what` names it in the error.

    Raises:
        UvmsError: of the type `error`: the text is not valid YAML; the message says where and why.
    """
    from ruamel.yaml import YAML  # not needed to import the package
    from ruamel.yaml.error import YAMLError

    try:
        data = YAML(typ="safe", pure=True).load(text)
        _check_size(data)
    except (YAMLError, ValueError, RecursionError) as fault:  # ValueError: the date 2020-99-99
        raise error(f"{what}: is not valid YAML: {_reason(fault)}") from fault
    return data


def read_yaml(path: Path, what: str, error: type[UvmsError]) -> Any:
    """The data of a YAML file in UTF-8; raises as `parse_yaml`, or that it cannot be read."""
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as fault:
        raise error(f"{what}: cannot be read: {fault.strerror}") from fault
    except UnicodeDecodeError as fault:
        reason = f"byte {fault.start} is not UTF-8"
        raise error(f"{what}: cannot be read: {reason}; save the file as UTF-8") from fault
    return parse_yaml(text, what, error)


def dump_yaml(data: Any, **options: Any) -> str:
    """Plain data as YAML that reads the same as version 1.1 and 1.2, in the order given.

    Args:
        options: of PyYAML's `dump`, such as `width`.
    """
    return str(yaml.dump(data, Dumper=_Dumper, sort_keys=False, **options))


class _Dumper(yaml.SafeDumper):
    """Quotes text that YAML 1.2 takes for a number, as PyYAML does for YAML 1.1."""


_Dumper.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$|^0o[0-7]+$"),
    list("-+.0123456789"),
)


def _check_size(data: Any) -> None:
    """ValueError for more than MAX_VALUES values, which a few nested aliases can stand for."""
    sizes: dict[int, int] = {}

    def size(value: Any) -> int:
        if not isinstance(value, (dict, list)):
            return 1
        if id(value) not in sizes:
            sizes[id(value)] = MAX_VALUES  # of a value that contains itself
            items = value.values() if isinstance(value, dict) else value
            sizes[id(value)] = 1 + sum(map(size, items))
        return sizes[id(value)]

    if size(data) > MAX_VALUES:
        raise ValueError(f"it has more than {MAX_VALUES} values, counting what aliases repeat")


def _reason(fault: Exception) -> str:
    """One line: where, and what is wrong there."""
    mark = getattr(fault, "problem_mark", None)
    if mark is None:
        text = str(fault).replace('in "<unicode string>", position', "at character")
        return " ".join(text.split())
    problem = str(getattr(fault, "problem", ""))
    if duplicate := _DUPLICATE.match(problem):
        problem = f"the key {duplicate[1]!r} is given twice"
    return f"line {mark.line + 1}, column {mark.column + 1}: {' '.join(problem.split())}"
