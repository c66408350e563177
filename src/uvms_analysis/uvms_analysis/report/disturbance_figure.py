"""Figure of the self-disturbance that the plan expects, against the true one."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.read import Series
from uvms_analysis.report import style

AXES = (("X", "K"), ("Y", "M"), ("Z", "N"))
KINDS = (("N", 0), ("N m", 3))


def planned_disturbance(run: Analysis) -> Figure:
    """Restoring plus coupling wrench, true and planned, axis by axis."""
    plan, true = run.planned_disturbance, run.disturbance
    figure = style.new_figure(5.6)
    grid = figure.subplots(3, 2, sharex=True)
    errors = run.planned_disturbance_error[1]
    for row, names in enumerate(AXES):
        for column, (unit, first) in enumerate(KINDS):
            axis = first + row
            axes = grid[row, column]
            _axis(axes, true, plan, axis)
            rms = np.sqrt(np.mean(errors[:, axis] ** 2)) if len(errors) else 0.0
            axes.set_title(f"{names[column]}   true less planned: rms {rms:.2g} {unit}", fontsize=9)
            axes.set_ylabel(unit)
    grid[0, 0].legend(loc="upper right", ncols=2, fontsize=7)
    for axes in grid[-1]:
        style.time_axis(axes, true.time)
    return figure


def _axis(axes: Axes, true: Series, plan: Series, axis: int) -> None:
    values = (true.restoring + true.coupling)[1:, axis]
    planned = (plan.restoring + plan.coupling)[:, axis]
    color = style.COLORS[axis % 3]
    axes.plot(
        style.thin(true.time[1:]), style.thin(values), color=color, linewidth=0.8, label="true"
    )
    axes.plot(style.thin(plan.time), style.thin(planned), label="planned", **style.REFERENCE)
    style.room_but_peaks(axes, np.concatenate([values, planned]), 0.05)
