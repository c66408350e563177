"""Builds the source of functions that walk a message, and tracks the alignment.

In CDR a number is at a multiple of its size from the start of the message. After a string the
position is unknown, so that padding is computed when the function runs; otherwise it is known when
the function is made, and neighboring numbers go into one call of `struct`.
"""

INDENT = "    "


class Alignment:
    """What is known of the position: its remainder `offset` by `modulus` (1, 2, 4 or 8)."""

    def __init__(self) -> None:
        self.modulus, self.offset = 8, 0

    def known(self, size: int) -> bool:
        """Whether the padding before a number of `size` bytes is known."""
        return size <= self.modulus

    def padding(self, size: int) -> int:
        """Bytes before a number of `size` bytes."""
        return -self.offset % size

    def advance(self, size: int) -> None:
        """The position moves on by `size` bytes."""
        self.offset = (self.offset + size) % self.modulus

    def set(self, modulus: int) -> None:
        """Only this is known: the position is a multiple of `modulus`."""
        self.modulus, self.offset = modulus, 0


class Source:
    """Lines of a function with their indent, and the objects that it names."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self.depth = 1
        self.objects: dict[str, object] = {}
        self._count = 0

    def line(self, text: str) -> None:
        """One more line."""
        self.lines.append(INDENT * self.depth + text)

    def name(self, stem: str) -> str:
        """A fresh name."""
        self._count += 1
        return f"{stem}{self._count}"

    def bind(self, stem: str, value: object) -> str:
        """A fresh name for an object that the function uses."""
        name = self.name(stem)
        self.objects[name] = value
        return name

    def build(self, signature: str, label: str):
        """The function, compiled."""
        text = "\n".join([f"def function({signature}):", *self.lines])
        space = dict(self.objects)
        exec(compile(text, f"<{label}>", "exec"), space)
        return space["function"]
