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
from uvms_core.yaml_nodes import MAX_VALUES, NodeError, check_nodes

__all__ = ["MAX_VALUES", "dump_yaml", "parse_yaml", "read_yaml"]

MAX_CHARACTERS = 500_000
"""Longest text that is read: the reader takes 6 us a character, so it is done in three seconds. The
longest vehicle file of the project has 12,000."""

MAX_DEPTH = 50
"""Most groups within one another; a vehicle file has eight."""

_DUPLICATE = re.compile(r'found duplicate key "(.*?)" with value', re.DOTALL)


def parse_yaml(text: str, what: str, error: type[UvmsError]) -> Any:
    """The data of a YAML text; `what` names it in the error.

    Raises:
        UvmsError: of the type `error`: the text is not valid YAML; the message says where and why.
    """
    from ruamel.yaml.error import YAMLError  # not needed to import the package

    try:
        return _load(text)
    except (YAMLError, ValueError, KeyError, RecursionError) as fault:
        # ValueError: of the date 2020-99-99; KeyError: of `!!bool maybe`
        raise error(f"{what}: is not valid YAML: {_reason(fault)}") from fault


def read_yaml(path: Path, what: str, error: type[UvmsError]) -> Any:
    """The data of a YAML file in UTF-8; raises as `parse_yaml`, or that it cannot be read."""
    try:
        with path.open("rb") as file:  # no more of it than is needed to see that it is too long
            text = file.read(4 * MAX_CHARACTERS + 1).decode("utf-8-sig")
    except (OSError, ValueError) as fault:
        raise error(f"{what}: cannot be read: {_unreadable(fault)}") from fault
    return parse_yaml(text, what, error)


def _unreadable(fault: OSError | ValueError) -> str:
    if isinstance(fault, OSError):
        return str(fault.strerror)
    if isinstance(fault, UnicodeDecodeError):
        return f"byte {fault.start} is not UTF-8; save the file as UTF-8"
    return str(fault)  # a NUL in the path


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


def _load(text: str) -> Any:
    """The data, once the nodes that they are made of have been checked."""
    from ruamel.yaml import YAML
    from ruamel.yaml.composer import Composer

    dates: list[Any] = []

    class CheckedComposer(Composer):
        def __init__(self, loader: Any = None) -> None:
            super().__init__(loader)
            self.warn_double_anchors = False  # YAML lets an anchor be given anew

        def compose_document(self) -> Any:
            root = super().compose_document()
            dates.extend(check_nodes(root))
            return root

    if len(text) > MAX_CHARACTERS:
        raise ValueError(f"it has more than {MAX_CHARACTERS} characters")
    reader = YAML(typ="safe", pure=True)
    reader.Composer, reader.max_depth = CheckedComposer, MAX_DEPTH
    data = reader.load(text)
    if dates:
        raise NodeError(f"{dates[0].value} is a date to YAML; put it in quotes", dates[0])
    return data


def _reason(fault: Exception) -> str:
    """One line: where, and what is wrong there."""
    from ruamel.yaml.composer import MaxDepthExceededError

    if isinstance(fault, MaxDepthExceededError):
        return f"maximum recursion depth exceeded: groups may be {MAX_DEPTH} deep in one another"
    mark = getattr(fault, "problem_mark", None)
    if mark is None:
        text = str(fault).replace('in "<unicode string>", position', "at character")
        return " ".join(text.split())
    problem = str(getattr(fault, "problem", ""))
    if duplicate := _DUPLICATE.match(problem):
        problem = f"the key {duplicate[1]!r} is given twice"
    return f"line {mark.line + 1}, column {mark.column + 1}: {' '.join(problem.split())}"
