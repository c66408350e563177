"""Plots of the vehicle's pose against its plan and its limits, and of what stays clear."""

from functools import partial
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.clearance import planned_clearances, run_geometry, true_clearances
from uvms_analysis.errors import LogError
from uvms_analysis.report.plot import Curve, Limit, Panel, Part, panel, panels
from uvms_analysis.report.plots.tracking import AXES, LEAST_M, truth_and_estimate
from uvms_analysis.report.run import ReportedRun
from uvms_core.checks import ATTITUDE_DEG
from uvms_core.signals import Array
from uvms_dynamics.geometry import AROUND, OWN, Geometry
from uvms_dynamics.kernels.rotations import quat_to_rpy

ANGLES = ("roll", "pitch", "yaw")
SHOWN = 4
"""Pairs of bodies with a line of their own: those that come closest."""


def attitude(run: ReportedRun) -> list[Panel]:
    """Roll, pitch and yaw; limits of the outcome and of the planner."""

    def angle(axis: int, of: Analysis) -> Curve:
        return of.truth.time, of.rpy_deg[:, axis]

    def planned(axis: int) -> Curve:
        plan = run.seen.planned
        if plan is None:
            raise LogError("the log has no reference")
        return plan.time, np.rad2deg([quat_to_rpy(q)[axis] for q in plan.quaternion])

    allowed = _planner_limits(run)
    wanted = []
    for axis, name in enumerate(ANGLES):
        parts = [*truth_and_estimate(run, partial(angle, axis)),
                 Part("planned", partial(planned, axis), "dash")]  # fmt: skip
        limits = []
        if name != "yaw":
            limits += [Limit("limit of the outcome", s * ATTITUDE_DEG) for s in (-1.0, 1.0)]
        if name in allowed:
            limits += [Limit("limit of the planner", s * allowed[name]) for s in (-1.0, 1.0)]
        wanted.append(partial(panel, name, name, "deg", parts, limits, least=0.1))
    return panels(wanted)


def _planner_limits(run: ReportedRun) -> dict[str, float]:
    """Greatest roll and pitch that the planner allows, degrees; those that the log knows."""
    found: dict[str, float] = {}
    try:
        _search(run.log.configuration().get("planner", {}), found)
    except LogError:
        return {}
    return found


def _search(values: Any, found: dict[str, float]) -> None:
    for key, value in values.items() if isinstance(values, dict) else ():
        _search(value, found)
        for angle in ("roll", "pitch"):
            if key == f"{angle}_max_deg" and isinstance(value, int | float):
                found[angle] = float(value)


def position(run: ReportedRun) -> list[Panel]:
    """Where the vehicle is, and where its reference wants it."""

    def place(axis: int, of: Analysis) -> Curve:
        return of.truth.time, of.truth.position[:, axis]

    def planned(axis: int) -> Curve:
        if run.seen.planned is None:
            raise LogError("the log has no reference")
        return run.seen.planned.time, run.seen.planned.position[:, axis]

    return panels([
        partial(panel, f"vehicle_{name}", f"vehicle, {name}", "m",
                [*truth_and_estimate(run, partial(place, axis)),
                 Part("planned", partial(planned, axis), "dash")], least=LEAST_M)
        for axis, name in enumerate(AXES)
    ])  # fmt: skip


def clearance(run: ReportedRun) -> list[Panel]:
    """Distances of bodies that must not touch, by the truth; planned: the least of all."""
    geometry = run_geometry(run.log)
    if not geometry.pairs:
        raise LogError("its vehicle has no two bodies that could touch")
    true = true_clearances(run.truth, geometry)
    planned = planned_clearances(run.truth, geometry)
    titles = (("clearance_arm", "arm from hull and itself", OWN),
              ("clearance_around", "from obstacles and seabed", AROUND))  # fmt: skip
    found = [
        _nearest(run, key, title, index, (geometry, true, planned))
        for key, title, kinds in titles
        if (index := [k for k, pair in enumerate(geometry.pairs) if pair.kind in kinds])
    ]
    if not found:
        raise LogError("its vehicle has no two bodies that could touch")
    return found


def _nearest(
    run: ReportedRun,
    key: str,
    title: str,
    index: list[int],
    known: tuple[Geometry, Array, Array | None],
) -> Panel:
    geometry, true, planned = known
    time = run.truth.truth.time
    closest = sorted(index, key=lambda k: float(true[:, k].min()))[:SHOWN]
    parts = [Part("least, true", lambda: (time, true[:, index].min(axis=1)))]
    parts += [
        Part(str(geometry.pairs[k]), partial(lambda k: (time, true[:, k]), k), "thin")
        for k in closest
    ]
    if planned is not None and run.truth.planned is not None:
        when, least = run.truth.planned.time, planned[:, index].min(axis=1)
        parts.append(Part("least, planned", lambda: (when, least), "dash"))
    return panel(key, title, "m", parts, [Limit("contact", 0.0)], least=0.05)
