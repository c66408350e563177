"""Functions that write a message, a nested dict, as CDR bytes."""

import struct
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from uvms_core.cdr.layout import Alignment, Source
from uvms_core.cdr.parse import PRIMITIVES, SEQUENCE, STRING, Field
from uvms_core.errors import CdrError

HEADER = b"\x00\x01\x00\x00"
"""Encapsulation: plain CDR, little endian."""

Types = Mapping[str, tuple[Field, ...]]


def _raw(values: Any, code: str, length: int, name: str) -> bytes:
    """Values of a primitive array as bytes."""
    array = np.asarray(values, dtype=f"<{code}")
    if array.ndim != 1 or (length != SEQUENCE and array.size != length):
        expected = f"({'any' if length == SEQUENCE else length},)"
        raise CdrError(f"{name} has shape {array.shape}; it must be {expected}")
    return array.tobytes()


class _Encoder:
    def __init__(self, types: Types) -> None:
        self.types = types
        self.source = Source()
        self.source.objects["raw"] = _raw
        self.align = Alignment()
        self.format = "<"
        self.values: list[str] = []

    def flush(self) -> None:
        """Write the numbers collected so far."""
        if self.values:
            pack = self.source.bind("pack", struct.Struct(self.format).pack)
            self.source.line(f"b += {pack}({', '.join(self.values)})")
        elif len(self.format) > 1:
            self.source.line(f"b += bytes({struct.calcsize(self.format)})")
        self.format, self.values = "<", []

    def pad(self, size: int) -> None:
        """Bring the position to a multiple of `size`."""
        if self.align.known(size):
            padding = self.align.padding(size)
            self.format += "x" * padding
            self.align.advance(padding)
            return
        self.flush()
        # The four bytes of the header are not counted, which matters only for 8.
        self.source.line(f"b += bytes((4 - len(b)) & {size - 1})")
        self.align.set(size)

    def number(self, code: str, size: int, value: str) -> None:
        self.pad(size)
        self.format += code
        self.values.append(value)
        self.align.advance(size)

    def text(self, value: str) -> None:
        name = self.source.name("s")
        self.source.line(f"{name} = {value}.encode()")
        self.number("I", 4, f"len({name}) + 1")
        self.flush()
        self.source.line(f"b += {name}; b.append(0)")
        self.align.set(1)

    def numbers(self, field: Field, value: str) -> None:
        code, size = PRIMITIVES[field.type]
        name = self.source.name("a")
        arguments = f"{value}, {code!r}, {field.length}, {field.name!r}"
        self.source.line(f"{name} = raw({arguments})")
        if field.length != SEQUENCE:
            self.pad(size)
            self.flush()
            self.source.line(f"b += {name}")
            self.align.advance(size * (field.length or 0))
            return
        self.number("I", 4, f"len({name}) // {size}")
        self.flush()
        # An empty sequence has no padding after its length.
        padding = f"bytes((4 - len(b)) & {size - 1}) + " if size > 4 else ""
        self.source.line(f"if {name}: b += {padding}{name}")
        self.align.set(min(size, 4))

    def each(self, field: Field, value: str) -> None:
        """A loop over texts or nested messages."""
        name = self.source.name("n")
        if field.length == SEQUENCE:
            self.source.line(f"{name} = {value}")
            self.number("I", 4, f"len({name})")
            value = name
        self.flush()
        element = self.source.name("e")
        self.source.line(f"for {element} in {value}:")
        self.source.depth += 1
        self.align.set(1)
        self.one(field.type, element)
        self.flush()
        self.source.depth -= 1
        self.align.set(1)

    def one(self, type_name: str, value: str) -> None:
        if type_name in PRIMITIVES:
            self.number(*PRIMITIVES[type_name], value)
        elif type_name == STRING:
            self.text(value)
        else:
            self.message(type_name, value)

    def message(self, type_name: str, value: str) -> None:
        if not value.isidentifier():
            name = self.source.name("m")
            self.source.line(f"{name} = {value}")
            value = name
        if not self.types[type_name]:
            self.number("B", 1, "0")  # an empty structure has one byte in IDL
        for field in self.types[type_name]:
            at = f"{value}[{field.name!r}]"
            if field.length is None:
                self.one(field.type, at)
            elif field.type in PRIMITIVES:
                self.numbers(field, at)
            else:
                self.each(field, at)


def make_encoder(types: Types, root: str) -> Callable[[Mapping[str, Any]], bytes]:
    """A function that writes messages of the type `root` as CDR bytes."""
    encoder = _Encoder(types)
    encoder.source.objects["header"] = HEADER
    encoder.source.line("b = bytearray(header)")
    encoder.message(root, "message")
    encoder.flush()
    encoder.source.line("return bytes(b)")
    return encoder.source.build("message", f"encode {root}")
