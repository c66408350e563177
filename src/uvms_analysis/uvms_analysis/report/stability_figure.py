"""Figure of the Lyapunov function along a run, and of the condition below eq. (29)."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import Series
from uvms_analysis.report import style

LEAST = 1e-9
"""V below this is drawn as this: the errors are then below 0.05 mm and 0.05 mrad."""


def stability(run: Analysis) -> Figure:
    """V of (27) and its rate over time, and both sides of the condition below (29)."""
    found = run.stability
    if len(found.time) < 2:
        raise LogError(f"log {run.log.path}: has a single {found.name}")
    figure = style.new_figure(6.2)
    value, rate, power = figure.subplots(3, 1, sharex=True)
    _value(value, found)
    _rate(rate, found)
    _power(power, found)
    style.time_axis(power, found.time)
    return figure


def _value(axes: Axes, found: Series) -> None:
    shown = np.maximum(found.lyapunov, LEAST)
    axes.semilogy(style.thin(found.time), style.thin(shown), color=style.COLORS[0], linewidth=0.9)
    axes.set_title("V of (27)")
    axes.set_ylabel("m²/s², rad²/s²")


def _rate(axes: Axes, found: Series) -> None:
    """What the law's model says of V, and what V does, disturbances that nobody knows included."""
    rate, happened = found.lyapunov_rate, np.gradient(found.lyapunov, found.time)
    grey = {"color": "#aaaaaa", "linewidth": 0.6, "label": "as it happens"}
    axes.plot(style.thin(found.time), style.thin(happened), **grey)
    color = style.COLORS[1]
    axes.plot(
        style.thin(found.time), style.thin(rate), color=color, linewidth=0.9, label="by model"
    )
    axes.axhline(0.0, **style.REFERENCE)
    falls = 100.0 * np.mean(rate <= 0.0)
    axes.set_title(f"its rate   by the model V does not grow at {falls:.1f} % of the ticks")
    axes.set_ylabel("per second")
    style.room_but_peaks(axes, np.concatenate([rate, happened]), 1e-9)
    style.legend(axes)


def _power(axes: Axes, found: Series) -> None:
    holds = found.supply >= found.demand
    for values, name, color in (
        (found.demand, "demand", style.COLORS[1]),
        (found.supply, "supply", style.COLORS[2]),
    ):
        axes.plot(
            style.thin(found.time), style.thin(values), color=color, linewidth=0.9, label=name
        )
    axes.axhline(0.0, **style.REFERENCE)
    axes.set_title(f"condition below (29)   holds at {100.0 * np.mean(holds):.1f} % of the ticks")
    axes.set_ylabel("W")
    style.room_but_peaks(axes, np.concatenate([found.demand, found.supply]), 1e-6)
    style.legend(axes)
