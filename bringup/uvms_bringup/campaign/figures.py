"""Figures of a campaign: the distribution of each required field, case by case."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.report import style
from uvms_bringup.campaign.row import Row
from uvms_bringup.campaign.statistics import is_number

LINE_IN, MARGIN_IN = 0.26, 0.9
"""Height of a line of a figure, and of what is around them, inches."""

GOOD, BAD = style.COLORS[0], style.COLORS[1]
BASELINES = ("s", "^", "D", "v", "P", "X")
"""Marks of the baselines' medians."""

WIDE = 50.0
"""Greatest over median value from which on an axis is logarithmic."""


def distribution(field: str, cases: dict, rows: list[Row]) -> Figure | None:
    """The figure of one field; None where no case has a number in it."""
    values = _by_case(field, cases, rows)
    if not values:
        return None
    figure = style.new_figure(MARGIN_IN + LINE_IN * len(values))
    _draw(figure.add_subplot(), field, cases, rows)
    return figure


def picture(title: str, fields: list[str], cases: dict, rows: list[Row]) -> Figure:
    """The distributions of all fields in one figure."""
    counts = {field: len(_by_case(field, cases, rows)) for field in fields}
    shown = {field: count for field, count in counts.items() if count}
    heights = [MARGIN_IN + LINE_IN * count for count in shown.values()]
    figure = style.new_figure(0.4 + sum(heights))
    figure.suptitle(title, fontsize=10)
    grid = figure.subplots(len(shown), 1, squeeze=False, height_ratios=heights)[:, 0]
    for axes, field in zip(grid, shown, strict=True):
        _draw(axes, field, cases, rows)
    return figure


def _by_case(field: str, cases: dict, rows: list[Row]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Numbers (k,), and whether the runs passed (k,), of the cases that have any."""
    names = [name for name, case in cases.items() if field in case["fields"]]
    values = {name: _values(field, name, rows) for name in names}
    return {name: one for name, one in values.items() if len(one[0])}


def _draw(axes: Axes, field: str, cases: dict, rows: list[Row]) -> None:
    """Every run as a dot, the median as a bar, baselines' medians as marks, limits as lines."""
    values, marks = _by_case(field, cases, rows), _marks(cases)
    for line, (name, (numbers, passed)) in enumerate(values.items()):
        _line(axes, line, numbers, passed)
        for baseline, mark in marks.items():
            own, _ = _values(field, f"{name}/{baseline}", rows)
            if len(own):
                axes.plot(np.median(own), line, mark, color="#777777", markersize=4, zorder=2)
        _limits(axes, line, cases[name]["fields"][field])
    _finish(axes, field, list(values), marks)
    everything = np.concatenate([numbers for numbers, _ in values.values()])
    if everything.min() > 0.0 and everything.max() > WIDE * np.median(everything):
        axes.set_xscale("log")


def _values(field: str, case: str, rows: list[Row]) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of a case (k,), and whether the runs passed (k,)."""
    own = [row for row in rows if row["case"] == case and is_number(row.get(field))]
    numbers = np.array([row[field] for row in own], dtype=float)
    return numbers, np.array([row["passed"] for row in own], dtype=bool)


def _marks(cases: dict) -> dict[str, str]:
    names = list(dict.fromkeys(name for case in cases.values() for name in case["baselines"]))
    return {name: BASELINES[k % len(BASELINES)] for k, name in enumerate(names)}


def _line(axes: Axes, line: int, numbers: np.ndarray, passed: np.ndarray) -> None:
    spread = np.linspace(-0.22, 0.22, len(numbers)) if len(numbers) > 1 else np.zeros(1)
    for which, color in ((passed, GOOD), (~passed, BAD)):
        axes.plot(
            numbers[which], line + spread[which], "o", color=color, markersize=3, alpha=0.75,
            markeredgewidth=0, zorder=3,
        )  # fmt: skip
    middle = float(np.median(numbers))
    axes.plot([middle, middle], [line - 0.32, line + 0.32], color="black", linewidth=1.4, zorder=4)


def _limits(axes: Axes, line: int, field: dict) -> None:
    for key in ("min", "max"):
        if (limit := field.get(key)) is not None:
            axes.plot([limit, limit], [line - 0.45, line + 0.45], color="#b22222", linewidth=1.0)


def _finish(axes: Axes, field: str, names: list[str], marks: dict[str, str]) -> None:
    axes.set_yticks(range(len(names)), names, fontsize=7)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_title(field)
    handles = [
        axes.plot([], [], "o", color=GOOD, markersize=4, label="passed")[0],
        axes.plot([], [], "o", color=BAD, markersize=4, label="failed")[0],
        axes.plot([], [], color="black", label="median")[0],
        axes.plot([], [], color="#b22222", label="limit")[0],
    ]
    handles += [
        axes.plot([], [], mark, color="#777777", markersize=4, linestyle="", label=name)[0]
        for name, mark in marks.items()
    ]
    axes.legend(
        handles=handles, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=len(handles),
        borderaxespad=0.1, fontsize=7,
    )  # fmt: skip
