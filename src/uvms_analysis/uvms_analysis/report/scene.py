"""The vehicle at work: a 3-D picture of a run, drawn without a window from its log alone.

The solid posture is the one in which the tool is farthest from its place at the start; the others
are ghosts. Shapes are those of the vehicle file. The tool's true path is a tube whose colour is the
time, enlarged in the corner with the path that was asked for. Arrows are thrusts and disturbance.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from uvms_analysis.analysis import Analysis
from uvms_analysis.clearance import run_obstacles
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.report import style
from uvms_analysis.report.arrows import Arrows, force_arrows
from uvms_analysis.report.posture import Posture, ball, body_shapes, obstacle_shapes, rod
from uvms_analysis.report.raycast import (
    Camera,
    Layer,
    Shape,
    blend,
    camera_axes,
    frame,
    render,
    shrink,
)
from uvms_core import topics
from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_matrix

NEEDED = (
    topics.TRUE_ODOMETRY,
    topics.TRUE_JOINT_STATES,
    topics.TRUE_DISTURBANCE,
    topics.ALLOCATION,
    topics.DIAGNOSTICS,
)
SIZE = (1600, 800)
"""Pixels of the picture."""
INSET = (0.26, 0.46)
"""Width and height of the enlarged path, as parts of the picture."""
EDGE = 0.025
DOTS_PER_INCH = 100
SMOOTH = 2
"""Pixels are computed so many times finer along each side, for smooth edges."""
GHOST = 0.32
"""Opacity of the postures beside the solid one."""
BEHIND = 0.6
"""Opacity of obstacles, which are drawn behind all else so that they hide nothing."""
POSTURES = 3
TUBE = 0.0045
"""Radius of the tool's path, as a part of the size of what is in view."""
TUBE_PIECES = 300
LABEL_GAP = 24
"""Between a tool and the time beside it, points."""
LIGHT = np.array([0.35, 0.6, -1.0])
"""Direction to the lamp, north-east-down."""
VIEW = (62.0, 14.0)
"""Azimuth, from north towards east, and elevation of the camera, degrees."""

TIME = LinearSegmentedColormap.from_list("time", ["#0a3d91", "#8e2d8f", "#e8590c"])
INK = "#22313f"
SI = {"m": 1.0, "cm": 0.01, "mm": 0.001}
TARGETS = {"path": "as asked for", "reference": "as planned", "start": "start"}
PATH_COLOUR = (0.25, 0.30, 0.35)


def draw_scene(
    log: RunLog | str | Path,
    path: str | Path,
    times_s: Sequence[float] | None = None,
    view_deg: tuple[float, float] = VIEW,
) -> Path:
    """Draw the picture of a run and return its file.

    Args:
        log: a log or its file.
        path: image to write; its suffix is the format: png, jpg, pdf, svg.
        times_s: instants of the postures, s, the solid one last; None: chosen by the tool's path.
        view_deg: azimuth and elevation of the camera, degrees.

    Raises:
        LogError: the log lacks poses, joints or vehicle, an instant lies outside it, or the file
            cannot be written.
    """
    log = log if isinstance(log, RunLog) else RunLog.open(log)
    log.load([topic for topic in NEEDED if log.has(topic)])  # in one pass
    with style.settings():
        figure = scene(Analysis(log), times_s, view_deg)
        try:
            figure.savefig(path, dpi=DOTS_PER_INCH)
        except (OSError, ValueError) as fault:
            raise LogError(f"{path}: cannot be written: {fault}") from fault
    return Path(path)


def scene(
    run: Analysis,
    times_s: Sequence[float] | None = None,
    view_deg: tuple[float, float] = VIEW,
) -> Figure:
    """The picture as a figure of matplotlib; arguments as `draw_scene`."""
    indices = _instants(run, times_s)
    postures = [_posture(run, index) for index in indices]
    bodies = [body_shapes(run.vehicle, posture) for posture in postures]
    arrows = force_arrows(run, postures[-1], camera_axes(*view_deg)[:, 2])
    camera = frame([s for body in bodies for s in body] + arrows.shapes, view_deg, _fine(SIZE))
    tube = _tube(run.end_effector, run.truth.time, TUBE * camera.height_m)
    figure = Figure(figsize=(SIZE[0] / DOTS_PER_INCH, SIZE[1] / DOTS_PER_INCH))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    solid = [*bodies[-1], *tube, *arrows.shapes]
    layers = [render(obstacle_shapes(run_obstacles(run.log)), camera, LIGHT, BEHIND)]
    layers += [render(shapes, camera, LIGHT, GHOST) for shapes in bodies[:-1]]
    layers.append(render(solid, camera, LIGHT))
    image = shrink(blend(layers, _background(camera.size)), SMOOTH)
    axes.imshow(image, extent=(0, SIZE[0], SIZE[1], 0))
    _label_postures(axes, camera, postures, run.end_effector[indices])
    _legend(axes, run, arrows)
    axes.set_axis_off()
    if tube:
        _inset(figure.add_axes(_free_corner(layers)), run, view_deg)
    return figure


def _fine(size: tuple[int, int]) -> tuple[int, int]:
    return SMOOTH * size[0], SMOOTH * size[1]


def _free_corner(layers: Sequence[Layer]) -> tuple[float, float, float, float]:
    """Left, bottom, width and height of the enlarged path: the emptier of the lower corners."""
    empty = np.all([~np.isfinite(layer.depth) for layer in layers], axis=0)
    rows, columns = (round(share * n) for share, n in zip(INSET[::-1], empty.shape, strict=True))
    left_is_free = empty[-rows:, :columns].sum() >= empty[-rows:, -columns:].sum()
    left = EDGE if left_is_free else 1.0 - EDGE - INSET[0]
    return left, 2.0 * EDGE, *INSET


def _background(size: tuple[int, int]) -> np.ndarray:
    """White, a little blue below."""
    share = np.linspace(0.0, 1.0, size[1])[:, None, None]
    image = (1 - share) * np.array([1.0, 1.0, 1.0]) + share * np.array([0.87, 0.935, 0.975])
    return np.broadcast_to(image, (size[1], size[0], 3))


def _posture(run: Analysis, index: int) -> Posture:
    truth, joints = run.truth, run.joints
    pose = truth.position[index], quat_to_matrix(truth.quaternion[index])
    return Posture(float(truth.time[index]), pose, joints.position[index])


def _instants(run: Analysis, times_s: Sequence[float] | None) -> list[int]:
    """Indices of the true odometry for the postures, the solid one last."""
    time = run.truth.time
    if times_s is None:
        return _spread(run.end_effector)
    if not times_s:
        raise LogError("times_s is empty; give at least one instant, s")
    for one in times_s:
        if not time[0] <= one <= time[-1]:
            raise LogError(
                f"time {one:g} s lies outside the log {run.log.path}: {time[0]:g} to {time[-1]:g} s"
            )
    return [int(np.argmin(np.abs(time - one))) for one in times_s]


def _spread(points: Array) -> list[int]:
    """The first of these points, and others as far as possible from those already chosen.

    The one farthest from the first comes last.
    """
    chosen = [0]
    distance = np.linalg.norm(points - points[0], axis=1)
    for _ in range(POSTURES - 1):
        chosen.append(int(np.argmax(distance)))
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
    return [chosen[0], *chosen[2:], chosen[1]]


def _tube(points: Array, time: Array, radius: float, plain: bool = False) -> list[Shape]:
    """Points along a path as short rods that meet in balls; colour by time, or plain."""
    if np.ptp(points, axis=0).max() < radius:
        return []
    marks = np.unique(np.linspace(0.0, len(points) - 1, TUBE_PIECES + 1).astype(int))
    shapes: list[Shape] = []
    for first, last in pairwise(marks):
        share = (time[last] - time[0]) / (time[-1] - time[0])
        colour = PATH_COLOUR if plain else TIME(share)[:3]
        if np.linalg.norm(points[last] - points[first]) > 1e-6:
            shapes.append(rod(points[first], points[last], radius, colour))
        shapes.append(ball(points[last], radius, colour))
    return shapes


def _inset(axes: Axes, run: Analysis, view_deg: tuple[float, float]) -> None:
    """The tool's path enlarged, with the path asked for as a thin line and a scale."""
    size = round(INSET[0] * SIZE[0]), round(INSET[1] * SIZE[1])
    reach = float(np.linalg.norm(np.ptp(run.end_effector, axis=0)))
    tube = _tube(run.end_effector, run.truth.time, 0.007 * reach)
    asked = _tube(run.target.position, run.truth.time[run.target.index], 0.003 * reach, plain=True)
    camera = frame([*tube, *asked], view_deg, _fine(size), margin=0.12)
    layers = [render([*tube, *asked], camera, LIGHT)]
    white = np.ones((camera.size[1], camera.size[0], 3))
    axes.imshow(shrink(blend(layers, white), SMOOTH), extent=(0, size[0], size[1], 0))
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(False)
    for spine in axes.spines.values():
        spine.set(visible=True, color="#b8c4cf", linewidth=1.0)
    axes.text(
        16,
        26,
        "true path" + (f"; thin: {TARGETS[run.target.kind]}" if asked else ""),
        color=INK,
        fontsize=10,
    )
    _scale_bar(axes, camera, size)


def _scale_bar(axes: Axes, camera: Camera, size: tuple[int, int]) -> None:
    """A round length of about a quarter of the width."""
    quarter = 0.25 * camera.height_m * size[0] / size[1]
    power = 10.0 ** np.floor(np.log10(quarter))
    length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= quarter)
    pixels = length / camera.height_m * size[1]
    left, low = 16.0, size[1] - 16.0
    axes.plot([left, left + pixels], [low, low], color=INK, linewidth=2.0, solid_capstyle="butt")
    units = ((1.0, "m"), (0.01, "cm"), (0.0, "mm"))
    unit = next(name for least, name in units if length >= 0.999 * least)
    text = f"{length / SI[unit]:g} {unit}"
    axes.text(left, low - 8.0, text, color=INK, fontsize=10)


def _label_postures(axes: Axes, camera: Camera, postures: Sequence[Posture], tools: Array) -> None:
    """The time of each posture beside its tool, the solid one first; none over another."""
    middle = SIZE[0] / 2
    taken: list[Array] = []
    places = camera.project(tools) / SMOOTH
    for posture, (x, y) in reversed(list(zip(postures, places, strict=True))):
        if any(np.hypot(x - a, y - b) < LABEL_GAP for a, b in taken):
            continue
        taken.append(np.array([x, y]))
        side = 1 if x < middle else -1
        axes.annotate(
            f"{posture.time:.0f} s",
            (x, y),
            (side * LABEL_GAP, -4),
            textcoords="offset points",
            ha="left" if side > 0 else "right",
            fontsize=11,
            color=INK,
            weight="bold" if posture is postures[-1] else "normal",
            path_effects=[withStroke(linewidth=3.0, foreground="white")],
        )


def _legend(axes: Axes, run: Analysis, arrows: Arrows) -> None:
    """What colours and arrows mean, in the upper right corner."""
    left, top, step = 0.70 * SIZE[0], 40.0, 30.0
    time = run.truth.time
    ramp = TIME(np.linspace(0.0, 1.0, 128))[None, :, :3]
    axes.imshow(ramp, extent=(left, left + 60, top + 3, top - 3), aspect="auto", zorder=3)
    axes.text(left + 74, top, f"true path of the tool, {time[0]:.0f} to {time[-1]:.0f} s",
              va="center", fontsize=11, color=INK)  # fmt: skip
    for number, (colour, text) in enumerate(arrows.meaning, start=1):
        y = top + number * step
        looks = {"arrowstyle": "-|>", "color": colour, "linewidth": 2.0}
        axes.annotate("", (left + 60, y), (left, y), arrowprops=looks)
        axes.text(left + 74, y, text, va="center", fontsize=11, color=INK)
    axes.set_xlim(0, SIZE[0])
    axes.set_ylim(SIZE[1], 0)
