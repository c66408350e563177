"""Arrows of what pushes the vehicle: thrusts, and the force of the disturbance."""

from dataclasses import dataclass, field

import numpy as np
from matplotlib.colors import to_rgb

from uvms_analysis.analysis import Analysis
from uvms_analysis.hull_chord import chord, tunnel
from uvms_analysis.log.read import Series
from uvms_analysis.report.posture import Posture, arrow
from uvms_analysis.report.raycast import Shape
from uvms_core.signals import Array
from uvms_core.vehicle.hull import Hull

THRUST, DISTURBANCE = "#0b7d5b", "#c2185b"
LONGEST = 0.16
"""Length of the longest arrow, as a part of the distance between the outermost thrusters."""
SHORTEST = 0.15
"""Arrows shorter than this part of the longest are left out."""
WIDTH = 0.0035
"""Radius of a shaft, as a part of the same distance."""


@dataclass(frozen=True)
class Push:
    """A force in the body frame, and the two ends of the body on its line, m along the force."""

    place: Array  # (3,) m
    force: Array  # (3,) N
    ends: tuple[float, float]


@dataclass
class Arrows:
    """Shapes, and what their colours mean."""

    shapes: list[Shape] = field(default_factory=list)
    meaning: list[tuple[str, str]] = field(default_factory=list)


def force_arrows(run: Analysis, posture: Posture, to_viewer: Array) -> Arrows:
    """Thrusts and the disturbance's force at the posture's time, all on one scale.

    Each arrow stands outside the hull and, where it can, on the side of the viewer (`to_viewer`
    (3,), map_ned), where it either leaves the vehicle or meets it.
    """
    groups = (
        (THRUST, "thrust, up to", 1.0, _thrusts(run, posture.time)),
        (DISTURBANCE, "disturbance,", 1.4, _disturbance(run, posture.time)),
    )
    greatest = max(float(np.linalg.norm(push.force)) for *_, pushes in groups for push in pushes)
    places = np.array([item.position_m for item in run.vehicle.thrusters])
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    scale, (position, R) = LONGEST * size / max(greatest, 1e-9), posture.pose
    found = Arrows()
    for colour, text, thickness, pushes in groups:
        shown = [p for p in pushes if np.linalg.norm(p.force) > SHORTEST * greatest]
        for push in shown:
            start = _start(run.vehicle.hull, push, scale, R.T @ to_viewer)
            radius, span = thickness * WIDTH * size, scale * R @ push.force
            found.shapes += arrow(position + R @ start, span, radius, to_rgb(colour))
        if shown:
            most = max(float(np.linalg.norm(push.force)) for push in shown)
            found.meaning.append((colour, f"{text} {most:.2g} N"))
    return found


def _thrusts(run: Analysis, time: float) -> list[Push]:
    pushes = []
    for item, value in zip(run.vehicle.thrusters, _at(run.allocation, "thrust", time), strict=True):
        place, along = np.array(item.position_m), np.array(item.direction)
        first, last = tunnel(run.vehicle, place, along)
        ends = (first, last) if value >= 0.0 else (-last, -first)
        pushes.append(Push(place, value * along, ends))
    return pushes


def _disturbance(run: Analysis, time: float) -> list[Push]:
    """Restoring, coupling and external force together, as if at the centre of buoyancy."""
    parts = ("restoring", "coupling", "external")
    wrench = np.sum([_at(run.disturbance, part, time) for part in parts], axis=0)
    force, place = np.asarray(wrench[:3]), np.array(run.vehicle.hull.cb_m)
    length = float(np.linalg.norm(force))
    ends = chord(run.vehicle.hull, place, force / length) if length > 0.0 else None
    return [Push(place, force, ends or (0.0, 0.0))]


def _start(hull: Hull, push: Push, scale: float, to_viewer: Array) -> Array:
    """Where the arrow begins (3,), body frame: it leaves the vehicle, or its tip meets it."""
    span = scale * push.force
    along = span / np.linalg.norm(span)
    leaving = push.place + push.ends[1] * along
    meeting = push.place + push.ends[0] * along - span
    free = [start for start in (leaving, meeting) if not _inside(hull, start + 0.5 * span, along)]
    return max(free or [leaving], key=lambda start: float((start + 0.5 * span) @ to_viewer))


def _inside(hull: Hull, point: Array, along: Array) -> bool:
    through = chord(hull, point, along)
    return through is not None and through[0] < 0.0 < through[1]


def _at(series: Series, name: str, time: float) -> Array:
    """A column at the last stamp up to a time."""
    row = int(np.searchsorted(series.time, time, side="right")) - 1
    return np.asarray(getattr(series, name)[max(row, 0)])
