"""Moving water as flat float64 tables, which numba kernels read.

Turning and oscillating currents are one kind of row: both are c cos(w t) + s sin(w t).
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.model.wet_bodies import build_wet_bodies
from uvms_dynamics.simulation.water.airy import wave_number
from uvms_dynamics.simulation.water.currents import (
    CurrentConfig,
    Gust,
    Oscillating,
    Turning,
    Wave,
)


class Water(NamedTuple):
    """What moves beside the constant current; `waves` and `bodies` are None without waves.

    numba compiles the plant anew for each of the three cases (still, stream, waves), so that one
    takes no time for what it does not have.
    """

    gravity: float  # m/s^2
    hull: Array  # (4,): mass of the water that it displaces, and its centre of buoyancy
    harmonics: Array  # (., 7): angular frequency, then vectors c and s
    gusts: Array  # (., 6): begin, end, 1 / rise, velocity
    waves: Array | None  # (., 7): k, omega, direction (2), phase, amplitude, depth
    bodies: Array | None  # (n + 1, .), see `kernels.waves`

    def around(self, vehicle: Vehicle) -> "Water":
        """The same flow around another vehicle."""
        bodies = None if self.bodies is None else build_wet_bodies(vehicle)
        return self._replace(hull=_displaced(vehicle), bodies=bodies)


def build_water(vehicle: Vehicle, current: CurrentConfig) -> Water | None:
    """Tables of moving water around a vehicle; None where only the constant current flows."""
    gravity = vehicle.environment.gravity_m_s2
    harmonics = [*_turning(current.turning), *map(_oscillating, current.oscillating)]
    waves = [_wave(wave, gravity) for wave in current.waves if wave.height_m > 0.0]
    gusts = [_gust(gust) for gust in current.gusts]
    if not (harmonics or gusts or waves):
        return None
    return Water(
        gravity,
        _displaced(vehicle),
        np.reshape(harmonics, (-1, 7)).astype(float),
        np.reshape(gusts, (-1, 6)).astype(float),
        np.array(waves) if waves else None,
        build_wet_bodies(vehicle) if waves else None,
    )


def _displaced(vehicle: Vehicle) -> Array:
    """Mass of the water that the hull displaces, and its centre of buoyancy (4,)."""
    hull, density = vehicle.hull, vehicle.environment.water_density_kg_m3
    return np.array([density * hull.volume_m3, *hull.cb_m])


def velocity_at_start(current: CurrentConfig) -> Array:
    """Velocity (3,) in the world of the uniform flow at t = 0, when no gust has begun."""
    rows = [*_turning(current.turning), *map(_oscillating, current.oscillating)]
    return np.sum([current.constant_ned_m_s, *(row[1:4] for row in rows)], axis=0)


def greatest_speed(current: CurrentConfig) -> float:
    """Bound of the water's speed, m/s: the sum of the parts' greatest, of waves at the surface."""
    constant = float(np.linalg.norm(current.constant_ned_m_s))
    gusts = sum(float(np.linalg.norm(gust.velocity_ned_m_s)) for gust in current.gusts)
    swings = sum(part.amplitude_m_s for part in current.oscillating)
    waves = 0.0
    for wave in current.waves:
        k = wave_number(wave.period_s, wave.water_depth_m)
        orbit = 0.5 * wave.height_m / math.tanh(k * wave.water_depth_m)
        waves += 2.0 * math.pi / wave.period_s * orbit
    return constant + current.turning.speed_m_s + gusts + swings + waves


def _turning(turning: Turning) -> Iterator[list[float]]:
    if turning.speed_m_s:
        along = turning.speed_m_s * _toward(turning.start_deg)
        across = turning.speed_m_s * _toward(turning.start_deg + 90.0)
        yield [2.0 * math.pi / turning.period_s, *along, *across]


def _oscillating(part: Oscillating) -> list[float]:
    """Of a sin(w t + phase) = a sin(phase) cos(w t) + a cos(phase) sin(w t)."""
    way, phase = part.amplitude_m_s * _toward(part.direction_deg), math.radians(part.phase_deg)
    return [2.0 * math.pi / part.period_s, *math.sin(phase) * way, *math.cos(phase) * way]


def _gust(gust: Gust) -> list[float]:
    return [gust.at_s, gust.at_s + gust.duration_s, 1.0 / gust.rise_s, *gust.velocity_ned_m_s]


def _wave(wave: Wave, gravity: float) -> list[float]:
    k = wave_number(wave.period_s, wave.water_depth_m, gravity)
    north, east, _ = _toward(wave.direction_deg)
    phase = math.radians(wave.phase_deg)
    omega = 2.0 * math.pi / wave.period_s
    return [k, omega, north, east, phase, 0.5 * wave.height_m, wave.water_depth_m]


def _toward(degrees: float) -> Array:
    """Unit vector (3,) toward a direction from north to east."""
    angle = math.radians(degrees)
    return np.array([math.cos(angle), math.sin(angle), 0.0])
