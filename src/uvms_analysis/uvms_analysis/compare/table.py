"""The fields of summaries that differ, with their units."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

UNITS = (
    ("_nm", "N m"),
    ("_n", "N"),
    ("_ms", "ms"),
    ("_s", "s"),
    ("_m", "m"),
    ("_deg", "deg"),
    ("_fraction", ""),
)
"""Ends of names and their units; the first that fits counts."""

LEFT_OUT = ("run_id", "start_up_s", "check.", "missing.")
"""Fields, or groups of them, that differ between any two runs or say nothing about the motion."""


@dataclass(frozen=True)
class Row:
    """One field: its name, unit, and value in each run."""

    name: str
    unit: str
    values: tuple[Any, ...]

    @property
    def texts(self) -> tuple[str, ...]:
        """The values as they are shown."""
        return tuple(map(text, self.values))

    @property
    def ratio(self) -> float | None:
        """The last value over the first, where both are numbers and the first is not 0."""
        first, last = self.values[0], self.values[-1]
        numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (first, last))
        return last / first if numbers and first else None


def text(value: Any) -> str:
    """A value as it is shown."""
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.4g}"
    if isinstance(value, list | tuple):
        return "; ".join(map(str, value)) or "none"
    return str(value)


def unit(name: str) -> str:
    """The unit that a dotted name ends on, in one of its parts."""
    for part in reversed(name.split(".")):
        for end, found in UNITS:
            if part.endswith(end):
                return found
    return ""


def differences(summaries: Sequence[Mapping[str, Any]]) -> Iterator[Row]:
    """The fields that are not the same in all summaries, in the order of the first."""
    names = dict.fromkeys(name for one in summaries for name in one)
    for name in names:
        values = tuple(one.get(name) for one in summaries)
        if not name.startswith(LEFT_OUT) and any(value != values[0] for value in values):
            yield Row(name, unit(name), values)


def as_text(names: Sequence[str], rows: Sequence[Row]) -> str:
    """The table for a terminal."""
    head = ("field", "unit", *names)
    lines = [head, *((row.name, row.unit, *row.texts) for row in rows)]
    widths = [min(max(len(line[k]) for line in lines), 60) for k in range(len(head))]
    return "\n".join(
        "  ".join(
            cell[:width].ljust(width) if k < 2 else cell[:width].rjust(width)
            for k, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )
