"""Figures of the forces on the vehicle, and of its navigation error."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.report import style
from uvms_core.vehicle.thrusters import Thruster

FORCE = ("X", "Y", "Z")
MOMENT = ("K", "M", "N")


def self_disturbance(run: Analysis) -> Figure:
    """Restoring and coupling wrench, forces and moments, true; the observed ones in grey."""
    figure = style.new_figure(5.6)
    grid = figure.subplots(2, 2, sharex=True)
    for row, part in zip(grid, ("restoring", "coupling"), strict=True):
        true, observed = getattr(run.disturbance, part), getattr(run.observed, part)
        halves = (("force", "N", FORCE, slice(0, 3)), ("moment", "N m", MOMENT, slice(3, 6)))
        for axes, (kind, unit, names, half) in zip(row, halves, strict=True):
            grey = {"color": "#aaaaaa", "linewidth": 0.6, "label": None}
            style.lines(axes, run.observed.time, observed[:, half], names, **grey)
            style.lines(axes, run.disturbance.time, true[:, half], names, linewidth=0.8)
            axes.set_title(f"{part} {kind}")
            axes.set_ylabel(unit)
            style.room_but_peaks(axes, true[:, half], 0.05)
            if part == "restoring":
                style.legend(axes)
            else:
                style.time_axis(axes, run.disturbance.time)
    return figure


def thrusters(run: Analysis) -> Figure:
    """Thrust of each thruster with its limits, ticks at a limit marked, and the missing wrench."""
    items = run.vehicle.thrusters
    count = -(-(len(items) + 1) // 2)
    figure = style.new_figure(0.8 + 1.55 * count)
    panels = list(figure.subplots(count, 2, sharex=True, squeeze=False).flat)
    for index, item in enumerate(items):
        _thruster(panels[index], run, index, item)
    _missing(panels[len(items)], run)
    for axes in panels[len(items) + 1 :]:
        axes.set_axis_off()
    for axes in panels[-2:]:
        style.time_axis(axes, run.allocation.time)
    return figure


def _thruster(axes: Axes, run: Analysis, index: int, item: Thruster) -> None:
    name, limit = item.name, item.greatest_n
    time = run.allocation.time
    thrust, at_limit = run.allocation.thrust[:, index], run.allocation.saturated[:, index]
    color = style.COLORS[index % len(style.COLORS)]
    axes.plot(style.thin(time), style.thin(thrust), color=color, linewidth=0.9)
    axes.plot(time[at_limit], thrust[at_limit], ".", color="#b22222", markersize=2.0)
    height = min(1.15 * limit, max(1.3 * float(np.abs(thrust).max()), 0.1 * limit))
    axes.set_ylim(-height, height)
    for bound in (item.astern_n, item.ahead_n):
        if abs(bound) < height:
            axes.axhline(bound, **style.LIMIT)
    axes.set_title(f"{name}  ({_range(item)} N)", fontsize=9)
    rms = np.sqrt(np.mean(thrust**2))
    text = f"rms {rms:.2g} N, at limit {100 * at_limit.mean():.1f} %"
    axes.text(1.0, 1.02, text, transform=axes.transAxes, ha="right", fontsize=8, color="#555555")
    axes.set_ylabel("N")


def _range(item: Thruster) -> str:
    if item.astern_n == -item.ahead_n:
        return f"±{item.ahead_n:g}"
    return f"{item.astern_n:g} to {item.ahead_n:g}"


def _missing(axes: Axes, run: Analysis) -> None:
    """Length of the part of the commanded wrench that the thrusters do not deliver."""
    time, residual = run.allocation.time, run.allocation.residual
    force = np.linalg.norm(residual[:, :3], axis=1)
    moment = np.linalg.norm(residual[:, 3:], axis=1)
    axes.plot(style.thin(time), style.thin(force), color="black", label="force / N")
    axes.plot(style.thin(time), style.thin(moment), color=style.COLORS[1], label="moment / N m")
    axes.set_ylim(0.0, max(1.15 * float(np.max([force, moment])), 1e-3))
    axes.set_title("commanded, not delivered", fontsize=9)
    style.legend(axes)


def navigation(run: Analysis) -> Figure:
    """Error of the estimated position with the filter's own three standard deviations."""
    time, error, deviation = run.navigation
    figure = style.new_figure(4.8)
    rows = figure.subplots(3, 1, sharex=True)
    for index, (axes, name) in enumerate(zip(rows, ("north", "east", "down"), strict=True)):
        mm, band = 1e3 * style.thin(error[:, index]), 3e3 * style.thin(deviation[:, index])
        inside = np.mean(np.abs(error[:, index]) <= 3 * deviation[:, index])
        axes.fill_between(style.thin(time), -band, band, label="3 σ", **style.BAND)
        axes.plot(style.thin(time), mm, color=style.COLORS[index], linewidth=0.9, label="error")
        axes.set_title(f"{name}   {100 * inside:.1f} % within 3 σ")
        axes.set_ylabel("mm")
    style.legend(rows[0])
    style.time_axis(rows[-1], time)
    return figure
