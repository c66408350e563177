"""Figures of what pushes the vehicle, and of how well it knows where it is."""

import numpy as np
from matplotlib.figure import Figure

from uvms_bringup.analysis import Analysis
from uvms_bringup.report import style

FORCE = ("X", "Y", "Z")
MOMENT = ("K", "M", "N")


def self_disturbance(run: Analysis) -> Figure:
    """Restoring and coupling wrench, forces and moments, true; what the observer saw in grey."""
    figure = style.new_figure(5.6)
    grid = figure.subplots(2, 2, sharex=True)
    for row, part in zip(grid, ("restoring", "coupling"), strict=True):
        true, observed = getattr(run.disturbance, part), getattr(run.observed, part)
        halves = (("force", "N", FORCE, slice(0, 3)), ("moment", "N m", MOMENT, slice(3, 6)))
        for axes, (kind, unit, names, half) in zip(row, halves, strict=True):
            grey = {"color": "#aaaaaa", "linewidth": 0.6, "label": None}
            style.lines(axes, run.observed.time, observed[:, half], names, **grey)
            style.lines(axes, run.disturbance.time, true[:, half], names)
            axes.set_title(f"{part} {kind}")
            axes.set_ylabel(unit)
            style.room(axes, true[:, half], 0.05)
            if part == "restoring":
                style.legend(axes)
            else:
                style.time_axis(axes, run.disturbance.time)
    return figure


def thrusters(run: Analysis) -> Figure:
    """Thrust of each thruster with its limits; ticks at which it is at them are marked."""
    items = run.vehicle.thrusters
    figure = style.new_figure(0.8 + 1.55 * -(-len(items) // 2))
    grid = figure.subplots(-(-len(items) // 2), 2, sharex=True, squeeze=False)
    time = run.allocation.time
    for index, (axes, item) in enumerate(zip(grid.flat, items, strict=False)):
        thrust, at_limit = run.allocation.thrust[:, index], run.allocation.saturated[:, index]
        color = style.COLORS[index % len(style.COLORS)]
        axes.plot(style.thin(time), style.thin(thrust), color=color, linewidth=0.9)
        axes.plot(time[at_limit], thrust[at_limit], ".", color="#b22222", markersize=2.0)
        for limit in (-item.limit_n, item.limit_n):
            axes.axhline(limit, **style.LIMIT)
        rms = np.sqrt(np.mean(thrust**2))
        axes.set_title(f"{item.name}   rms {rms:.1f} N, at its limit {100 * at_limit.mean():.1f} %")
        axes.set_ylabel("N")
        axes.set_ylim(-1.15 * item.limit_n, 1.15 * item.limit_n)
    for axes in list(grid.flat)[len(items) :]:
        axes.set_axis_off()
    for axes in list(grid.flat)[max(len(items) - 2, 0) : len(items)]:
        axes.xaxis.set_tick_params(labelbottom=True)
        style.time_axis(axes, time)
    return figure


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
