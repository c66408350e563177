"""Reads YAML that people write: one clear error, and no key twice."""

from pathlib import Path
from typing import Any

import yaml

from uvms_core.errors import UvmsError


class _UniqueKeyLoader(yaml.SafeLoader):
    """YAML as usual, but a key given twice is an error instead of the last one winning."""

    def compose_mapping_node(self, anchor: Any) -> yaml.MappingNode:
        # Looked at before `<<` puts the keys of other mappings in, which may be given again.
        node = super().compose_mapping_node(anchor)
        seen = set()
        for key, _ in node.value:
            name = (key.tag, key.value) if isinstance(key, yaml.ScalarNode) else None
            if name is not None and name in seen:
                raise yaml.composer.ComposerError(
                    None, None, f"the key {key.value!r} is given twice", key.start_mark
                )
            seen.add(name)
        return node


def parse_yaml(text: str, what: str, error: type[UvmsError]) -> Any:
    """The data of a YAML text; `what` names it in the error.

    Raises:
        UvmsError: of the type `error`: the text is not valid YAML; the message says where and why.
    """
    try:
        return yaml.load(text, Loader=_UniqueKeyLoader)
    except (yaml.YAMLError, ValueError, RecursionError) as fault:  # ValueError: the date 2020-99-99
        raise error(f"{what}: is not valid YAML: {_reason(fault)}") from fault


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


def _reason(fault: Exception) -> str:
    """One line: where, and what is wrong there."""
    mark = getattr(fault, "problem_mark", None)
    if mark is None:
        return " ".join(str(fault).split())
    return f"line {mark.line + 1}, column {mark.column + 1}: {getattr(fault, 'problem', '')}"
