"""What a plot of the report is: panels of one quantity each, with lines over time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from uvms_analysis.errors import LogError, determine
from uvms_analysis.report.run import ReportedRun
from uvms_core.signals import Array

Style = Literal["solid", "thin", "dash", "high", "low"]
"""How a line is drawn. Solid lines are what the panel is about: they stay where several runs are
laid over one another. `high` and `low` are the two edges of one band."""

Curve = tuple[Array, Array]
"""Time (k,) in s and values (k,)."""


@dataclass(frozen=True)
class Line:
    """One line of a panel."""

    name: str
    time: Array  # (k,) s
    values: Array  # (k,) in the panel's unit; NaN: a gap
    style: Style = "solid"


@dataclass(frozen=True)
class Limit:
    """A horizontal line that the values should not cross, in the panel's unit."""

    name: str
    value: float


@dataclass(frozen=True)
class Panel:
    """One quantity over time; `unit` is empty where it has none.

    `least` is the smallest span of the vertical axis, so that noise does not look like motion;
    `peaks` may lie outside of it where they would dwarf the rest, which the page then says.
    """

    key: str
    title: str
    unit: str
    lines: tuple[Line, ...]
    limits: tuple[Limit, ...] = ()
    least: float = 0.0
    is_log: bool = False
    peaks: bool = False
    lacks: tuple[str, ...] = ()  # lines that the log does not determine, and why


@dataclass(frozen=True)
class Part:
    """A line that is still to be worked out, since the log may lack what it needs."""

    name: str
    work: Callable[[], Curve]
    style: Style = "solid"


@dataclass(frozen=True)
class Group:
    """Panels that belong together under a heading, worked out for one run at a time."""

    key: str
    title: str
    caption: str
    draw: Callable[[ReportedRun], list[Panel]]
    is_open: bool = True


def panel(
    key: str,
    title: str,
    unit: str,
    parts: Sequence[Part],
    limits: Sequence[Limit] = (),
    least: float = 0.0,
    is_log: bool = False,
    peaks: bool = False,
) -> Panel:
    """A panel with those of the parts that the log determines; says which ones it does not.

    Raises:
        LogError: it determines none.
    """
    lines: list[Line] = []
    lacks: list[str] = []
    for part in parts:
        try:
            lines.append(determine(lambda part=part: _line(part)))  # type: ignore[misc]
        except LogError as fault:
            lacks.append(f"{part.name}: {fault}")
    if not lines:
        raise LogError("; ".join(dict.fromkeys(lack.partition(": ")[2] for lack in lacks)))
    return Panel(key, title, unit, tuple(lines), tuple(limits), least, is_log, peaks, tuple(lacks))


def panels(wanted: Sequence[Callable[[], Panel]]) -> list[Panel]:
    """Those of the panels that the log determines.

    Raises:
        LogError: it determines none.
    """
    found, reasons = [], []
    for work in wanted:
        try:
            found.append(work())
        except LogError as fault:
            reasons.append(str(fault))
    if not found:
        raise LogError("; ".join(dict.fromkeys(reasons)) or "there is nothing of it in the log")
    return found


def _line(part: Part) -> Line:
    time, values = part.work()
    time, values = np.asarray(time, dtype=float), np.asarray(values, dtype=float)
    if time.ndim != 1 or time.shape != values.shape:
        raise LogError(f"{part.name} has {values.shape} values at {time.shape} times")
    if not len(time):
        raise LogError("has no value while this counts")
    return Line(part.name, time, values, part.style)
