"""Arrows of what pushes the vehicle: thrusts, and the force of the disturbance."""

from dataclasses import dataclass, field

import numpy as np
from matplotlib.colors import to_rgb

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.read import Series
from uvms_analysis.report.posture import Posture, arrow, chord, tunnel
from uvms_analysis.report.raycast import Shape
from uvms_core.signals import Array

THRUST, DISTURBANCE = "#0b7d5b", "#c2185b"
LONGEST = 0.16
"""Length of the longest arrow, as a part of the distance between the outermost thrusters."""
SHORTEST = 0.15
"""Arrows shorter than this part of the longest are left out."""
WIDTH = 0.0035
"""Radius of a shaft, as a part of the same distance."""


@dataclass
class Arrows:
    """Shapes, and what their colours mean."""

    shapes: list[Shape] = field(default_factory=list)
    meaning: list[tuple[str, str]] = field(default_factory=list)


def force_arrows(run: Analysis, posture: Posture) -> Arrows:
    """Thrusts and the disturbance's force at the posture's time, all on one scale."""
    thrust = _at(run.allocation, "thrust", posture.time)
    parts = ("restoring", "coupling", "external")
    wrench = np.sum([_at(run.disturbance, part, posture.time) for part in parts], axis=0)
    force = np.asarray(wrench[:3])
    places = np.array([item.position_m for item in run.vehicle.thrusters])
    size = float(np.linalg.norm(np.ptp(places, axis=0)))
    greatest = max(float(np.abs(thrust).max()), float(np.linalg.norm(force)), 1e-9)
    scale, radius = LONGEST * size / greatest, WIDTH * size
    found = Arrows()
    position, R = posture.pose
    for item, place, value in zip(run.vehicle.thrusters, places, thrust, strict=True):
        along = np.array(item.direction)
        if abs(value) >= SHORTEST * greatest:
            start = place + tunnel(run.vehicle, place, along)[int(value > 0.0)] * along
            span = scale * value * (R @ along)
            found.shapes += arrow(position + R @ start, span, radius, to_rgb(THRUST))
    if found.shapes:
        found.meaning.append((THRUST, f"thrust, up to {np.abs(thrust).max():.2g} N"))
    length = float(np.linalg.norm(force))
    if length >= SHORTEST * greatest:
        through = chord(run.vehicle.hull, np.array(run.vehicle.hull.cb_m), -force / length)
        ends = through[1] * force / length if through is not None else np.zeros(3)
        span = scale * R @ force
        found.shapes += arrow(position - R @ ends - span, span, 1.4 * radius, to_rgb(DISTURBANCE))
        found.meaning.append((DISTURBANCE, f"disturbance, {length:.2g} N"))
    return found


def _at(series: Series, name: str, time: float) -> Array:
    """A column at the last stamp up to a time."""
    row = int(np.searchsorted(series.time, time, side="right")) - 1
    return np.asarray(getattr(series, name)[max(row, 0)])
