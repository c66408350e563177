"""Style of the figures."""

from collections.abc import Sequence
from typing import Any

import matplotlib
import matplotlib.ticker
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_core.signals import Array

COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
"""The palette of Okabe and Ito, which people with colour blindness can distinguish."""

REFERENCE: dict[str, Any] = {"color": "#444444", "linewidth": 0.9, "linestyle": (0, (4, 2))}
LIMIT: dict[str, Any] = {"color": "#b22222", "linewidth": 0.8, "linestyle": (0, (1, 1.5))}
BAND: dict[str, Any] = {"color": "#888888", "alpha": 0.22, "linewidth": 0.0}

_SETTINGS: dict[Any, Any] = {
    "font.size": 9.0,
    "font.family": "DejaVu Sans",
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.edgecolor": "#555555",
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "figure.dpi": 110.0,
    "savefig.dpi": 110.0,
    "figure.facecolor": "white",
}
WIDTH = 9.2
"""Inches."""

POINTS = 6000
"""Points that a line has at most; more would be invisible."""


def settings() -> Any:
    """A context with the settings of all figures."""
    return matplotlib.rc_context(_SETTINGS)


def new_figure(height: float) -> Figure:
    """A figure of the common width; no window system is needed."""
    return Figure(figsize=(WIDTH, height), layout="constrained")


def thin(values: Array) -> Array:
    """Every n-th sample, so that a line has at most `POINTS`."""
    return values[:: max(1, -(-len(values) // POINTS))]


def lines(axes: Axes, time: Array, values: Array, names: Sequence[str], **how: Any) -> None:
    """One line per column, in the common colours."""
    for index, name in enumerate(names):
        options = {"color": COLORS[index % len(COLORS)], "label": name} | how
        axes.plot(thin(time), thin(values[:, index]), **options)


def legend(axes: Axes, columns: int = 3) -> None:
    """A legend above the axes, out of the way of the lines."""
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=columns, borderaxespad=0.1)


def time_axis(axes: Axes, time: Array) -> None:
    """Label and limits of a time axis."""
    axes.set_xlabel("t / s")
    if len(time) > 1:
        axes.set_xlim(float(time[0]), float(time[-1]))


def room(axes: Axes, values: Array, least: float) -> None:
    """Limits that show the values, but span at least `least`."""
    _limit(axes, float(np.min(values)), float(np.max(values)), least)


def room_but_peaks(axes: Axes, values: Array, least: float) -> None:
    """As `room`, but cut off a few peaks that would dwarf the rest, and print the greatest."""
    low, high = np.percentile(values, (0.1, 99.9))
    room_for = 1.5 * max(high - low, least)
    peak = float(values.flat[np.argmax(np.abs(values))])
    if np.ptp(values) <= 2.0 * room_for:
        room(axes, values, least)
        return
    _limit(axes, float(low), float(high), room_for)
    text = f"peak {peak:.3g}"
    axes.text(0.99, 0.95, text, transform=axes.transAxes, ha="right", va="top", fontsize=8)


def _limit(axes: Axes, low: float, high: float, least: float) -> None:
    middle, half = (low + high) / 2, max(high - low, least) * 0.55
    axes.set_ylim(middle - half, middle + half)


def ticks(count: int) -> Any:
    """A locator of at most `count` round ticks."""
    return matplotlib.ticker.MaxNLocator(count)
