"""Functions that read CDR bytes as objects with the fields of the message as attributes."""

import struct
from collections.abc import Callable, Mapping
from dataclasses import make_dataclass
from typing import Any

import numpy as np

from uvms_core.cdr.layout import Alignment, Source
from uvms_core.cdr.parse import PRIMITIVES, SEQUENCE, STRING, Field

Types = Mapping[str, tuple[Field, ...]]


class _Decoder:
    def __init__(self, types: Types) -> None:
        self.types = types
        self.source = Source()
        self.source.objects["frombuffer"] = np.frombuffer
        self.classes: dict[str, str] = {}
        self.align = Alignment()
        self.format = "<"
        self.targets: list[str] = []
        self.later: list[str] = []  # objects that need numbers not read yet

    def flush(self) -> None:
        """Read the numbers collected so far, then make the objects that need them."""
        size = struct.calcsize(self.format)
        if self.targets:
            unpack = self.source.bind("unpack", struct.Struct(self.format).unpack_from)
            self.source.line(f"{', '.join(self.targets)}, = {unpack}(d, p)")
        if size:
            self.source.line(f"p += {size}")
        for line in self.later:
            self.source.line(line)
        self.format, self.targets, self.later = "<", [], []

    def pad(self, size: int) -> None:
        """Bring the position to a multiple of `size`."""
        if self.align.known(size):
            padding = self.align.padding(size)
            self.format += "x" * padding
            self.align.advance(padding)
            return
        self.flush()
        # The four bytes of the header are not counted, which matters only for 8.
        self.source.line(f"p += (4 - p) & {size - 1}")
        self.align.set(size)

    def number(self, code: str, size: int) -> str:
        self.pad(size)
        name = self.source.name("x")
        self.format += code
        self.targets.append(name)
        self.align.advance(size)
        return name

    def text(self) -> str:
        length = self.number("I", 4)
        self.flush()
        name = self.source.name("s")
        self.source.line(f"{name} = str(d[p:p + {length} - 1], 'utf-8'); p += {length}")
        self.align.set(1)
        return name

    def numbers(self, field: Field) -> str:
        code, size = PRIMITIVES[field.type]
        count = str(field.length)
        if field.length == SEQUENCE:
            count = self.number("I", 4)
            self.flush()
            if size > 4:  # an empty sequence has no padding after its length
                self.source.line(f"if {count}: p += (4 - p) & {size - 1}")
        else:
            self.pad(size)
            self.flush()
        name = self.source.name("a")
        self.source.line(f"{name} = frombuffer(d, '<{code}', {count}, p); p += {count} * {size}")
        if field.length == SEQUENCE:
            self.align.set(min(size, 4))
        else:
            self.align.advance(size * (field.length or 0))
        return name

    def each(self, field: Field) -> str:
        """A list of texts or nested messages."""
        count = self.number("I", 4) if field.length == SEQUENCE else str(field.length)
        self.flush()
        name = self.source.name("l")
        self.source.line(f"{name} = []")
        self.source.line(f"for _ in range({count}):")
        self.source.depth += 1
        self.align.set(1)
        element = self.one(field.type)
        self.flush()
        self.source.line(f"{name}.append({element})")
        self.source.depth -= 1
        self.align.set(1)
        return name

    def one(self, type_name: str) -> str:
        if type_name in PRIMITIVES:
            return self.number(*PRIMITIVES[type_name])
        return self.text() if type_name == STRING else self.message(type_name)

    def message(self, type_name: str) -> str:
        fields = self.types[type_name]
        if not fields:
            self.number("B", 1)  # an empty structure has one byte in IDL
        names = [self.field(field) for field in fields]
        name = self.source.name("m")
        self.later.append(f"{name} = {self.make(type_name, fields)}({', '.join(names)})")
        return name

    def field(self, field: Field) -> str:
        if field.length is None:
            return self.one(field.type)
        return self.numbers(field) if field.type in PRIMITIVES else self.each(field)

    def make(self, type_name: str, fields: tuple[Field, ...]) -> str:
        if type_name not in self.classes:
            cls = make_dataclass(
                type_name.split("/")[1],
                [field.name for field in fields],
                slots=True,
                eq=False,
            )
            self.classes[type_name] = self.source.bind("Class", cls)
        return self.classes[type_name]


def make_decoder(types: Types, root: str) -> Callable[[bytes], Any]:
    """A function that reads CDR bytes as a message of the type `root`."""
    decoder = _Decoder(types)
    decoder.source.line("p = 4")
    name = decoder.message(root)
    decoder.flush()
    decoder.source.line(f"return {name}, p")
    return decoder.source.build("d", f"decode {root}")
