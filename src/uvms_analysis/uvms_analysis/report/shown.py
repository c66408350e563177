"""The plots of a page as data: of one run, or of several laid over one another."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from uvms_analysis.errors import LogError, determine
from uvms_analysis.report.plot import Group, Line, Panel
from uvms_analysis.report.questions import QUESTIONS
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.report.samples import Times

PLAN = -1
"""Number of the colour of lines that are no measurement: plans, targets."""


@dataclass(frozen=True)
class PanelShown:
    """What the page says of a panel in words."""

    key: str
    title: str
    unit: str
    description: str
    notes: tuple[str, ...]


@dataclass
class Shown:
    """The panels of each group, why others are missing, and the data of all of them."""

    panels: dict[str, list[PanelShown]] = field(default_factory=dict)
    missing: dict[str, list[str]] = field(default_factory=dict)
    plots: dict[str, dict[str, Any]] = field(default_factory=dict)
    times: Times = field(default_factory=Times)
    span: list[float] = field(default_factory=list)  # s; of all lines that panels are about

    def data(self, marks: Sequence[Mapping[str, Any]] = ()) -> dict[str, Any]:
        """What the script of the page reads; `marks` are instants with a text."""
        return {
            "times": self.times.encoded,
            "plots": self.plots,
            "marks": list(marks),
            "span": self.span,
        }


def show(runs: Sequence[ReportedRun]) -> Shown:
    """All plots of one run, or of several laid over one another."""
    shown = Shown()
    for question in QUESTIONS:
        for group in question.groups:
            _show_group(shown, group, runs)
    return shown


def _show_group(shown: Shown, group: Group, runs: Sequence[ReportedRun]) -> None:
    drawn: dict[str, list[Panel]] = {}
    reasons: list[str] = []
    for run in runs:
        try:
            drawn[run.name] = determine(partial(group.draw, run))
        except LogError as fault:
            reason = str(fault).removeprefix(f"log {run.log.path}: ")
            reasons.append(reason if len(runs) == 1 else f"{run.name}: {reason}")
    if reasons:
        shown.missing[group.key] = reasons
    names = [run.name for run in runs]
    keys = dict.fromkeys(panel.key for panels in drawn.values() for panel in panels)
    for key in keys:
        of_runs = {
            names.index(name): panel
            for name, panels in drawn.items()
            for panel in panels
            if panel.key == key
        }
        _show_panel(shown, group.key, of_runs, names)


def _show_panel(
    shown: Shown, group: str, of_runs: Mapping[int, Panel], names: Sequence[str]
) -> None:
    first = next(iter(of_runs.values()))
    several = len(names) > 1
    lines = _overlaid(of_runs, names) if several else _of_one(first)
    shown.plots[first.key] = {
        "unit": first.unit,
        "lines": [
            {"name": line.name, "style": line.style, "colour": colour}
            | shown.times.line(line.time, line.values)
            for colour, line in lines
        ],
        "limits": [{"name": limit.name, "value": limit.value} for limit in first.limits],
        "least": first.least,
        "log": first.is_log,
        "peaks": first.peaks,
    }
    ends = [float(end) for _, line in lines if line.style == "solid" for end in line.time[[0, -1]]]
    shown.span = [min([*shown.span, *ends]), max([*shown.span, *ends])] if ends else shown.span
    notes = [lack if not several else f"{names[number]}: {lack}"
             for number, panel in of_runs.items() for lack in panel.lacks]  # fmt: skip
    notes += [f"{name}: not in its log" for number, name in enumerate(names)
              if number not in of_runs]  # fmt: skip
    description = "; ".join(_range(line, first.unit) for _, line in lines if line.style != "low")
    shown.panels.setdefault(group, []).append(
        PanelShown(first.key, first.title, first.unit, f"{first.title}. {description}",
                   tuple(notes))
    )  # fmt: skip


def _of_one(panel: Panel) -> list[tuple[int, Line]]:
    """The lines with numbers of colours."""
    coloured = [line for line in panel.lines if line.style in ("solid", "thin")]
    return [
        (next((k for k, each in enumerate(coloured) if each is line), PLAN), line)
        for line in panel.lines
    ]  # fmt: skip


def _overlaid(of_runs: Mapping[int, Panel], names: Sequence[str]) -> list[tuple[int, Line]]:
    """What the panel is about, of each run in its own colour; a second such line is dashed."""
    found = []
    for number, panel in of_runs.items():
        own = [line for line in panel.lines if line.style == "solid"] or [panel.lines[0]]
        for count, line in enumerate(own):
            name = f"{names[number]}: {line.name}"
            style = "dash" if count else "solid"
            found.append((number, Line(name, line.time, line.values, style)))  # type: ignore[arg-type]
    return found


def _range(line: Line, unit: str) -> str:
    """What a line does, for whoever cannot see it."""
    values = line.values[np.isfinite(line.values)]
    if not len(values):
        return f"{line.name}: no values"
    return f"{line.name}: from {values.min():.4g} to {values.max():.4g} {unit}".strip()
