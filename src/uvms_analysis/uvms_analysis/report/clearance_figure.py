"""Figure of how clear arm, hull, obstacles and seabed are of one another along a run."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.clearance import planned_clearances, run_geometry, true_clearances
from uvms_analysis.errors import LogError
from uvms_analysis.report import style
from uvms_core.signals import Array
from uvms_dynamics.geometry import AROUND, OWN, Geometry

SHOWN = 4
"""Pairs with a line of their own in each part: those that come closest."""


def clearance(run: Analysis) -> Figure:
    """Distances over time, true and as planned: of the arm, and of what stands around."""
    geometry = run_geometry(run.log)
    parts = [
        (title, index)
        for title, kinds in (("arm from hull and itself", OWN), ("obstacles and seabed", AROUND))
        if (index := [k for k, pair in enumerate(geometry.pairs) if pair.kind in kinds])
    ]
    if not parts:
        raise LogError(f"log {run.log.path}: its vehicle has no two bodies that could touch")
    true, planned = true_clearances(run, geometry), planned_clearances(run, geometry)
    figure = style.new_figure(0.8 + 2.2 * len(parts))
    rows = figure.subplots(len(parts), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (title, index) in zip(rows, parts, strict=True):
        chosen = sorted(index, key=lambda k: float(true[:, k].min()))[:SHOWN]
        _lines(axes, run, geometry, chosen, true, planned)
        axes.set_title(f"{title}: least {1e3 * true[:, chosen[0]].min():.1f} mm")
        axes.set_ylabel("m")
    style.time_axis(rows[-1], run.truth.time)
    return figure


def _lines(
    axes: Axes,
    run: Analysis,
    geometry: Geometry,
    chosen: list[int],
    true: Array,
    planned: Array | None,
) -> None:
    """One line a pair, the plan dashed."""
    names = [str(geometry.pairs[k]) for k in chosen]
    if planned is not None and run.planned is not None:
        for k in chosen:
            axes.plot(style.thin(run.planned.time), style.thin(planned[:, k]), **style.REFERENCE)
    style.lines(axes, run.truth.time, true[:, chosen], names)
    axes.axhline(0.0, **style.LIMIT)
    axes.set_ylim(min(0.0, float(np.min(true[:, chosen]))) - 0.02, None)
    style.legend(axes, columns=2)
