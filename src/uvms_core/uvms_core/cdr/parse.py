"""Reads message definitions."""

import re
from dataclasses import dataclass

from uvms_core.errors import DefinitionError

PRIMITIVES: dict[str, tuple[str, int]] = {
    "bool": ("?", 1),
    "byte": ("B", 1),
    "char": ("B", 1),
    "int8": ("b", 1),
    "uint8": ("B", 1),
    "int16": ("h", 2),
    "uint16": ("H", 2),
    "int32": ("i", 4),
    "uint32": ("I", 4),
    "int64": ("q", 8),
    "uint64": ("Q", 8),
    "float32": ("f", 4),
    "float64": ("d", 8),
}
"""Format character of `struct` (and numpy) and size in bytes."""

STRING = "string"
SEQUENCE = -1
"""Length of an array that is stored with its length."""

_TYPE = re.compile(
    r"^(?P<type>[A-Za-z][\w/]*)(<=\d+)?(?P<array>\[(?P<bound><=)?(?P<count>\d*)\])?$"
)


@dataclass(frozen=True)
class Field:
    """One field: its type (`package/Name` if nested) and None, a fixed length or SEQUENCE."""

    name: str
    type: str
    length: int | None = None

    @property
    def is_primitive(self) -> bool:
        """Whether the type is a number, a bool or a string."""
        return self.type in PRIMITIVES or self.type == STRING


def parse_fields(package: str, text: str) -> tuple[Field, ...]:
    """Fields of one definition; constants, comments and defaults are left out."""
    lines = (line.split("#", 1)[0].split() for line in text.splitlines())
    return tuple(
        _field(package, words[0], words[1])
        for words in lines
        if len(words) >= 2 and "=" not in words[1] and not (len(words) > 2 and words[2][0] == "=")
    )


def _field(package: str, type_name: str, name: str) -> Field:
    match = _TYPE.match(type_name)
    if match is None or match["type"] == "wstring":
        raise DefinitionError(f"field {name}: type {type_name!r} is not supported")
    base = match["type"]
    if base not in PRIMITIVES and base != STRING:
        base = _qualified(package, base)
    if match["array"] is None:
        return Field(name, base)
    fixed = match["count"] and not match["bound"]
    return Field(name, base, int(match["count"]) if fixed else SEQUENCE)


def _qualified(package: str, name: str) -> str:
    """`package/Name` of a nested type, which may be given bare or with `msg` between."""
    parts = name.split("/")
    return f"{parts[0]}/{parts[-1]}" if len(parts) > 1 else f"{package}/{name}"


def parse_schema(name: str, text: str) -> dict[str, tuple[Field, ...]]:
    """Fields of every type in a schema text, by `package/Name`; the root comes first."""
    head, *rest = re.split(r"^={80}\s*$", text, flags=re.MULTILINE)
    package = name.split("/")[0]
    types = {_qualified(package, name): parse_fields(package, head)}
    for section in rest:
        mark, _, body = section.lstrip().partition("\n")
        if not mark.startswith("MSG: "):
            raise DefinitionError(f"{name}: a dependency starts with {mark!r}, not 'MSG: '")
        short = _qualified("", mark.removeprefix("MSG: ").strip())
        types[short] = parse_fields(short.split("/")[0], body)
    return types
