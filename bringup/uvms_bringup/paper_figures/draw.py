"""The figures."""

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.report import style
from uvms_bringup.paper_figures.numbers import (
    ELBOW_DEG,
    FORCE,
    MOMENT,
    PHASE_S,
    SETTLED_S,
    added_inertia,
    phase,
)
from uvms_bringup.paper_figures.runs import BLIND, FREE, MANIPULATION, OBSERVED, Runs
from uvms_core.signals import Array
from uvms_core.vehicle import load_vehicle

ATTITUDE = ("roll", "pitch")
LIMITS_DEG = (5.0, 4.0)
"""Of roll and pitch, (17)."""


def fig6(runs: Runs) -> Figure:
    """The arm's added inertia against the elbow angle."""
    figure = style.new_figure(height=3.2)
    axes = figure.subplots()
    names = "about the swing axis", "about the shoulder axis"
    style.lines(axes, ELBOW_DEG, added_inertia(load_vehicle("reference_auv")), names)
    axes.set(xlabel="elbow angle / deg", ylabel="added inertia / kg m$^2$")
    axes.set(xlim=(0.0, ELBOW_DEG[-1]), ylim=(0.0, None), xticks=ELBOW_DEG[::3])
    axes.set_title("Added inertia of the arm")
    style.legend(axes)
    return figure


def fig7(runs: Runs) -> Figure:
    """The vehicle without control while the arm moves."""
    run = runs[FREE]
    figure = style.new_figure(height=6.0)
    joints, attitude, restoring, coupling = figure.subplots(2, 2).flat
    _joints(joints, run)
    _over_time(attitude, run.truth.time, run.rpy_deg[:, :2], ATTITUDE, "attitude / deg")
    _disturbance(restoring, run, "restoring", MOMENT)
    _disturbance(coupling, run, "coupling", FORCE)
    return figure


def fig8(runs: Runs) -> Figure:
    """The vehicle under control with and without the observer."""
    figure = style.new_figure(height=6.0)
    joints, without, restoring, with_it = figure.subplots(2, 2).flat
    _joints(joints, runs[OBSERVED])
    _disturbance(restoring, runs[OBSERVED], "restoring", MOMENT)
    for axes, name, title in (
        (without, BLIND, "without the observer"),
        (with_it, OBSERVED, "with it: another scale"),
    ):
        run = runs[name]
        _over_time(axes, run.truth.time, run.rpy_deg[:, :2], ATTITUDE, "attitude / deg")
        axes.set_title(title)
    return figure


def fig9(runs: Runs) -> Figure:
    """The manipulation."""
    run = runs[MANIPULATION]
    figure = style.new_figure(height=11.0)
    grid = figure.subplots(4, 2)
    _trajectory(grid[0, 0], run, 0, "north of the start / m")
    _trajectory(grid[0, 1], run, 1, "east of the start / m")
    _joints(grid[1, 0], run)
    _over_time(grid[1, 1], run.truth.time, run.rpy_deg[:, :2], ATTITUDE, "attitude / deg")
    grid[1, 1].set_title(f"limits: {LIMITS_DEG[0]:g}° and {LIMITS_DEG[1]:g}°")
    for row, part in enumerate(("restoring", "coupling"), start=2):
        _disturbance(grid[row, 0], run, part, FORCE)
        _disturbance(grid[row, 1], run, part, MOMENT)
    return figure


FIGURES: Mapping[int, Callable[[Runs], Figure]] = {6: fig6, 7: fig7, 8: fig8, 9: fig9}
"""By their number in the paper; Fig. 10 is a picture of the viewer."""


def _joints(axes: Axes, run: Analysis) -> None:
    names = run.vehicle.joint_names
    _over_time(axes, run.joints.time, np.degrees(run.joints.position), names, "joints / deg")


def _disturbance(axes: Axes, run: Analysis, part: str, rows: slice) -> None:
    """Observed force or moment of a part, from when the first moments are over."""
    time = run.observed.time
    later = time >= SETTLED_S
    values = getattr(run.observed, part)[later, rows]
    kind, unit = ("force", "N") if rows == FORCE else ("moment", "N m")
    names = ("K", "M", "N") if rows == MOMENT else ("X", "Y", "Z")
    _over_time(axes, time[later], values, names, f"{part} {kind} / {unit}")
    style.room_but_peaks(axes, values, 1e-3)


def _over_time(axes: Axes, time: Array, values: Array, names: tuple[str, ...], label: str) -> None:
    style.lines(axes, time, values, names)
    style.time_axis(axes, time)
    axes.set_ylabel(label)
    style.legend(axes, columns=4)


def _trajectory(axes: Axes, run: Analysis, column: int, label: str) -> None:
    """The tool in a vertical plane, phase by phase, with the path asked for."""
    start = run.target.position[0]
    asked = run.target.position - start
    for index in range(3):
        tool = phase(run, index) - start
        span = f"{PHASE_S * index:g}-{PHASE_S * (index + 1):g} s"
        color = style.COLORS[index]
        axes.plot(style.thin(tool[:, column]), style.thin(tool[:, 2]), color=color, label=span)
    axes.plot(style.thin(asked[:, column]), style.thin(asked[:, 2]), **style.REFERENCE)
    axes.set(xlabel=label, ylabel="below the start / m", xlim=(-0.12, 0.12))
    axes.invert_yaxis()
    style.legend(axes)
