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
    ("_wh", "Wh"),
    ("_w", "W"),
    ("_h", "h"),
    ("_v", "V"),
)
"""Ends of names and their units; the first that fits counts."""

VEHICLE, SCENARIO = "vehicle", "scenario"
"""Fields that are shown even where they are the same in all runs: what is compared."""

OF_SOME_RUNS = ("node_counters.",)
"""Groups that have other fields in each kind of run; those that a run has not got say nothing."""

LEFT_OUT = ("run_id", "start_up_s", "check.", "missing.")
"""Fields, or groups of them, that differ between any two runs or say nothing about the motion."""

GAP = 2
LEAST = 10
"""Spaces between columns, and the least width of a column with values."""


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
    """What is compared, and the fields that differ, in the order of the first summary."""
    names = dict.fromkeys(name for one in summaries for name in one)
    for name in names:
        values = tuple(one.get(name) for one in summaries)
        if name in (VEHICLE, SCENARIO):
            yield Row(name, "", values)
        elif not _is_left_out(name, summaries) and any(value != values[0] for value in values):
            yield Row(name, unit(name), values)


def _is_left_out(name: str, summaries: Sequence[Mapping[str, Any]]) -> bool:
    is_in_all = all(name in one for one in summaries)
    return name.startswith(LEFT_OUT) or (name.startswith(OF_SOME_RUNS) and not is_in_all)


def as_text(names: Sequence[str], rows: Sequence[Row], width: int = 100) -> str:
    """The table for a terminal of that many columns; long cells end on `…`."""
    head = ("field", "unit", *names)
    lines = [head, *((row.name, row.unit, *row.texts) for row in rows)]
    widths = [max(len(line[k]) for line in lines) for k in range(len(head))]
    room = width - sum(widths[:2]) - GAP * (len(widths) - 1)
    widths[2:] = _shared(widths[2:], room)
    return "\n".join(
        (" " * GAP)
        .join(
            _cut(cell, own).ljust(own) if k < 2 else _cut(cell, own).rjust(own)
            for k, (cell, own) in enumerate(zip(line, widths, strict=True))
        )
        .rstrip()
        for line in lines
    )


def _shared(wanted: Sequence[int], room: int) -> list[int]:
    """Widths of columns that together fit; the widest give way."""
    limit = max(wanted, default=0)
    while limit > LEAST and sum(min(one, limit) for one in wanted) > room:
        limit -= 1
    return [min(one, limit) for one in wanted]


def _cut(cell: str, width: int) -> str:
    return cell if len(cell) <= width else f"{cell[: width - 1]}…"
