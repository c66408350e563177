"""What a check found."""

from dataclasses import dataclass

FILE, END, SPAN, COUNT, ORDER, CONTENT, COMMANDS = (
    "file",
    "end",
    "span",
    "count",
    "order",
    "content",
    "commands",
)
"""Kinds of checks."""


@dataclass(frozen=True)
class Finding:
    """One finding: its kind, what it says, and the topic where it is about one.

    A finding that is not serious is a note: the log is complete in spite of it.
    """

    kind: str
    text: str
    topic: str = ""
    serious: bool = True

    def __str__(self) -> str:
        return f"{self.topic}: {self.text}" if self.topic else self.text
