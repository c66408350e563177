"""Plots of how well tool, vehicle and joints follow what they should."""

from collections.abc import Callable
from functools import partial

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.limits import END_EFFECTOR, JOINTS, VEHICLE
from uvms_analysis.report.plot import Curve, Limit, Panel, Part, Style, panel, panels
from uvms_analysis.report.run import ReportedRun
from uvms_core.signals import Array

AXES = ("north", "east", "down")
TARGETS = {"path": "its path", "reference": "its plan", "start": "where it was at the start"}
LEAST_M = 0.002
"""Span of an axis of metres at the least."""


def tool_error(run: ReportedRun) -> list[Panel]:
    """How far the tool is off its target: as the loop sees it, and truly; length and axes."""
    off = TARGETS[run.seen.target.kind]

    def length(of: Analysis) -> Curve:
        return _tool_time(of), 1e3 * np.linalg.norm(of.end_effector_error, axis=1)

    def along(axis: int, of: Analysis) -> Curve:
        return _tool_time(of), 1e3 * of.end_effector_error[:, axis]

    limit = Limit("limit", 1e3 * END_EFFECTOR.near)
    whole = partial(
        panel, "tool_error", f"tool off {off}", "mm", _both(run, length), [limit], least=1.0
    )
    rest = [
        partial(panel, f"tool_error_{name}", f"tool off {off}, {name}", "mm",
                _both(run, partial(along, axis)), least=1.0)
        for axis, name in enumerate(AXES)
    ]  # fmt: skip
    return panels([whole, *rest])


def _tool_time(of: Analysis) -> Array:
    return of.truth.time[of.target.index]


def _both(run: ReportedRun, work: Callable[[Analysis], Curve]) -> list[Part]:
    """What the loop sees and the truth: both are what the panel is about."""
    return [
        Part("seen by the loop", lambda: work(run.seen)),
        Part("true", lambda: work(run.truth)),
    ]


def tool_position(run: ReportedRun) -> list[Panel]:
    """Where the tool is and where it should be."""

    def place(axis: int, of: Analysis) -> Curve:
        return of.truth.time, of.end_effector[:, axis]

    def target(axis: int) -> Curve:
        return _tool_time(run.seen), run.seen.target.position[:, axis]

    return panels([
        partial(panel, f"tool_{name}", f"tool, {name}", "m",
                [*truth_and_estimate(run, partial(place, axis)),
                 Part("target", partial(target, axis), "dash")], least=LEAST_M)
        for axis, name in enumerate(AXES)
    ])  # fmt: skip


def truth_and_estimate(run: ReportedRun, work: Callable[[Analysis], Curve]) -> list[Part]:
    """What happened, and thinner what the loop took for it."""
    thin: Style = "thin"
    return [
        Part("true", lambda: work(run.truth)),
        Part("estimated", lambda: work(run.seen), thin),
    ]


def vehicle_error(run: ReportedRun) -> list[Panel]:
    """How far the vehicle is off its reference: length and axes."""

    def length(of: Analysis) -> Curve:
        time, error = of.vehicle_error
        return time, 1e3 * np.linalg.norm(error, axis=1)

    def along(axis: int, of: Analysis) -> Curve:
        time, error = of.vehicle_error
        return time, 1e3 * error[:, axis]

    limit = Limit("limit", 1e3 * VEHICLE.near)
    whole = partial(panel, "vehicle_error", "vehicle off its reference", "mm",
                    _both(run, length), [limit], least=1.0)  # fmt: skip
    rest = [
        partial(panel, f"vehicle_error_{name}", f"vehicle off its reference, {name}", "mm",
                _both(run, partial(along, axis)), least=1.0)
        for axis, name in enumerate(AXES)
    ]  # fmt: skip
    return panels([whole, *rest])


def joints(run: ReportedRun) -> list[Panel]:
    """Each joint's angle, planned and within its limits, and how far it is off its plan."""
    vehicle = run.seen.vehicle

    def angle(index: int, of: Analysis) -> Curve:
        return of.joints.time, np.rad2deg(of.joints.position[:, index])

    def planned(index: int) -> Curve:
        if run.seen.planned is None:
            raise LogError("the log has no reference")
        return run.seen.planned.time, np.rad2deg(run.seen.planned.q[:, index])

    def off(index: int, of: Analysis) -> Curve:
        time, error = of.joint_error_deg
        return time, error[:, index]

    found = []
    for index, joint in enumerate(vehicle.arm.joints):
        limits = [Limit("lower limit", joint.lower_deg), Limit("upper limit", joint.upper_deg)]
        parts = [*truth_and_estimate(run, partial(angle, index)),
                 Part("planned", partial(planned, index), "dash")]  # fmt: skip
        found.append(partial(panel, f"joint_{joint.name}", f"joint {joint.name}", "deg",
                             parts, limits, least=0.5))  # fmt: skip
    near = [Limit("limit", sign * JOINTS.near) for sign in (-1.0, 1.0)]
    found += [
        partial(panel, f"joint_error_{joint.name}", f"joint {joint.name} off its plan", "deg",
                _both(run, partial(off, index)), near, least=0.1)
        for index, joint in enumerate(vehicle.arm.joints)
    ]  # fmt: skip
    return panels(found)
