"""Figures of the motion of vehicle, joints and end effector."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.report import style
from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_rpy

PLANES = (("north", "east", 0, 1), ("north", "down", 0, 2), ("east", "down", 1, 2))
TARGETS = {
    "path": "path",
    "reference": "as planned",
    "start": "start (held)",
}


def joints(run: Analysis) -> Figure:
    """Joint angles over time, with the plan and the limits."""
    names, time = run.vehicle.joint_names, run.joints.time
    degrees = np.rad2deg(run.joints.position)
    figure = style.new_figure(1.2 + 1.25 * len(names))
    rows = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    for index, (axes, name) in enumerate(zip(rows, names, strict=True)):
        color = style.COLORS[index % len(style.COLORS)]
        axes.plot(style.thin(time), style.thin(degrees[:, index]), color=color, label="true")
        if run.planned is not None:
            planned = np.rad2deg(run.planned.q[:, index])
            axes.plot(run.planned.time, planned, label="planned", **style.REFERENCE)
        style.room(axes, degrees[:, index], 2.0)
        joint = run.vehicle.arm.joints[index]
        _limits(axes, joint.lower_deg, joint.upper_deg)
        axes.set_title(f"θ{index + 1}  {name}")
        axes.set_ylabel("deg")
        if index == 0:
            style.legend(axes)
    style.time_axis(rows[-1], time)
    return figure


def _limits(axes: Axes, low: float, high: float) -> None:
    """Limits as lines, where they are in view."""
    bottom, top = axes.get_ylim()
    for limit in (low, high):
        if bottom <= limit <= top:
            axes.axhline(limit, **style.LIMIT)


def attitude_limits(run: Analysis) -> tuple[float | None, float | None]:
    """Greatest roll and pitch in degrees that the planner allows, None where it has no limit."""
    found: dict[str, float] = {}
    _search(run.log.configuration().get("planner", {}), found)
    return found.get("roll"), found.get("pitch")


def _search(values: Any, found: dict[str, float]) -> None:
    for key, value in values.items() if isinstance(values, dict) else ():
        _search(value, found)
        for angle in ("roll", "pitch"):
            if key == f"{angle}_max_deg":
                found[angle] = float(value)


def attitude(run: Analysis) -> Figure:
    """Roll, pitch and yaw over time, true and estimated, with the planner's limits."""
    figure = style.new_figure(5.4)
    rows = figure.subplots(3, 1, sharex=True)
    estimated = np.rad2deg(np.array([quat_to_rpy(q) for q in run.estimate.quaternion]))
    limits = (*attitude_limits(run), None)
    for index, (axes, name) in enumerate(zip(rows, ("roll φ", "pitch θ", "yaw ψ"), strict=True)):
        axes.plot(
            style.thin(run.estimate.time), style.thin(estimated[:, index]),
            color="#999999", linewidth=0.8, label="estimated",
        )  # fmt: skip
        values = run.rpy_deg[:, index]
        color = style.COLORS[index]
        axes.plot(style.thin(run.truth.time), style.thin(values), color=color, label="true")
        style.room(axes, values, 1.0)
        limit = limits[index]
        if limit is not None:
            _limits(axes, -limit, limit)
        axes.set_title(name if limit is None else f"{name}   (limit ±{limit:g}°)")
        axes.set_ylabel("deg")
    style.legend(rows[0])
    style.time_axis(rows[-1], run.truth.time)
    return figure


def end_effector(run: Analysis) -> Figure:
    """The end effector in space and in three planes against its target, and the error."""
    figure = style.new_figure(7.4)
    grid = figure.add_gridspec(3, 3, height_ratios=(1.0, 1.0, 0.85))
    target, true = run.target.position, run.end_effector[run.target.index]
    label = TARGETS[run.target.kind]
    space = figure.add_subplot(grid[:2, :2], projection="3d")
    space.plot(*style.thin(target).T, label=label, **style.REFERENCE)
    space.plot(*style.thin(true).T, color=style.COLORS[0], label="true")
    _cube(space, np.vstack([target, true]))
    space.legend(loc="upper left")
    spots = (grid[0, 2], grid[1, 2], grid[2, 2])
    for spot, (across, up, i, j) in zip(spots, PLANES, strict=True):
        axes = figure.add_subplot(spot)
        axes.plot(style.thin(target[:, i]), style.thin(target[:, j]), **style.REFERENCE)
        axes.plot(style.thin(true[:, i]), style.thin(true[:, j]), color=style.COLORS[0])
        axes.set_xlabel(f"{across} / m")
        axes.set_ylabel(f"{up} / m")
        axes.set_aspect("equal", adjustable="datalim")
        if up == "down":
            axes.invert_yaxis()
    _error(figure.add_subplot(grid[2, :2]), run)
    return figure


def _cube(space: Any, points: Array) -> None:
    """The same scale along all three axes, down pointing down."""
    middle = (points.max(axis=0) + points.min(axis=0)) / 2
    half = max(np.ptp(points, axis=0).max() / 2, 0.01) * 1.05
    space.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    space.set_zlim(middle[2] + half, middle[2] - half)
    space.set_xlabel("north / m")
    space.set_ylabel("east / m")
    space.set_zlabel("down / m")
    space.set_box_aspect((1, 1, 1), zoom=0.9)
    space.view_init(elev=22, azim=-58)
    for axis in (space.xaxis, space.yaxis, space.zaxis):
        axis.pane.set_facecolor("white")
        axis.set_major_locator(style.ticks(5))


def _error(axes: Axes, run: Analysis) -> None:
    time = run.truth.time[run.target.index]
    error = 1e3 * run.end_effector_error
    style.lines(axes, time, error, ("north", "east", "down"), linewidth=0.7)
    length = np.linalg.norm(error, axis=1)
    rms = np.sqrt(np.mean(length**2)) if len(length) else 0.0
    axes.plot(style.thin(time), style.thin(length), color="black", linewidth=1.1, label="length")
    axes.set_title(f"error: rms {rms:.1f} mm, max {length.max(initial=0.0):.1f} mm")
    axes.set_ylabel("mm")
    axes.legend(loc="upper right", ncols=4, fontsize=7)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.18 * (high - low))  # room for the legend
    style.time_axis(axes, time)


def vehicle(run: Analysis) -> Figure:
    """The vehicle's pose over time, true and planned."""
    figure = style.new_figure(4.6)
    grid = figure.subplots(2, 3, sharex=True)
    pose = np.column_stack([run.truth.position, run.rpy_deg])
    plan = _planned_pose(run)
    names = ("north", "east", "down", "roll φ", "pitch θ", "yaw ψ")
    for index, (axes, name) in enumerate(zip(grid.flat, names, strict=True)):
        linear = index < 3
        values, color = pose[:, index], style.COLORS[index % 3]
        axes.plot(style.thin(run.truth.time), style.thin(values), color=color, label="true")
        if plan is not None and run.planned is not None:
            axes.plot(run.planned.time, plan[:, index], label="planned", **style.REFERENCE)
            values = np.concatenate([values, plan[:, index]])
        style.room(axes, values, 0.02 if linear else 1.0)
        axes.set_title(name)
        axes.set_ylabel("m" if linear else "deg")
        if index == 2:
            axes.invert_yaxis()
            style.legend(axes)
        if not linear:
            style.time_axis(axes, run.truth.time)
    return figure


def _planned_pose(run: Analysis) -> Array | None:
    if run.planned is None:
        return None
    rpy = np.rad2deg(np.array([quat_to_rpy(q) for q in run.planned.quaternion]))
    return np.column_stack([run.planned.position, rpy])
