"""How the water moves, in plain numpy, to compare the kernels with.

Each part is written as its definition; waves as Newman, Marine Hydrodynamics (1977), ch. 6, has
them, with z down. What the water does is a `simulation.CurrentConfig`, whose fields are read here.
"""

import functools
import math
from typing import Any, NamedTuple

import numpy as np

from uvms_core.signals import Array


class Flow(NamedTuple):
    """The water at one place and time."""

    velocity: Array  # (3,) m/s in the world
    rate: Array  # (3,) its partial derivative by time, m/s^2
    gradient: Array  # (3, 3), 1/s: row i, column j: derivative of component i along axis j

    @property
    def acceleration(self) -> Array:
        """Material acceleration (3,) Du/Dt = du/dt + (u . grad) u, m/s^2."""
        return self.rate + self.gradient @ self.velocity


def flow_at(current: Any, place: Array, time: float, gravity: float) -> Flow:
    """The sum of all parts at a place (3,) in the world, m, and a time, s."""
    uniform = [_turning(current.turning, time)]
    uniform += [_oscillating(part, time) for part in current.oscillating]
    uniform += [_gust(gust, time) for gust in current.gusts]
    velocity = np.array(current.constant_ned_m_s) + sum(part[0] for part in uniform)
    rate, gradient = np.sum([part[1] for part in uniform], axis=0), np.zeros((3, 3))
    for wave in current.waves:
        part = wave_flow(wave, place, time, gravity)
        velocity = velocity + part.velocity
        rate, gradient = rate + part.rate, gradient + part.gradient
    return Flow(velocity, rate, gradient)


def wave_flow(wave: Any, place: Array, time: float, gravity: float) -> Flow:
    """One wave: u = a omega C cos psi along it, w = -a omega S sin psi down."""
    h, omega = wave.water_depth_m, 2.0 * np.pi / wave.period_s
    k = _wave_number(omega, h, gravity)
    along = _toward(wave.direction_deg)
    down = np.array([0.0, 0.0, 1.0])
    z = min(max(place[2], 0.0), h)
    psi = k * (along @ place) - omega * time + np.radians(wave.phase_deg)
    across_shape = np.cosh(k * (h - z)) / np.sinh(k * h)
    down_shape = np.sinh(k * (h - z)) / np.sinh(k * h)
    speed = 0.5 * wave.height_m * omega
    u, w = speed * across_shape * np.cos(psi), -speed * down_shape * np.sin(psi)
    u_psi, w_psi = -speed * across_shape * np.sin(psi), -speed * down_shape * np.cos(psi)
    u_z, w_z = -k * speed * down_shape * np.cos(psi), k * speed * across_shape * np.sin(psi)
    gradient = k * np.outer(u_psi * along + w_psi * down, along)
    gradient += np.outer(u_z * along + w_z * down, down)
    return Flow(u * along + w * down, -omega * (u_psi * along + w_psi * down), gradient)


@functools.cache
def _wave_number(omega: float, depth: float, gravity: float) -> float:
    """Root of omega^2 = g k tanh(k h), 1/m, by bisection between bounds that hold at any depth."""
    low, high = omega**2 / gravity, omega**2 / gravity + omega / math.sqrt(gravity * depth)
    while low < (middle := 0.5 * (low + high)) < high:
        if gravity * middle * math.tanh(middle * depth) < omega**2:
            low = middle
        else:
            high = middle
    return high


def _turning(turning: Any, time: float) -> tuple[Array, Array]:
    rate = 2.0 * np.pi / turning.period_s
    direction = turning.start_deg + np.degrees(rate * time)
    speed = turning.speed_m_s
    return speed * _toward(direction), speed * rate * _toward(direction + 90.0)


def _oscillating(part: Any, time: float) -> tuple[Array, Array]:
    omega = 2.0 * np.pi / part.period_s
    phase = omega * time + np.radians(part.phase_deg)
    way = part.amplitude_m_s * _toward(part.direction_deg)
    return way * np.sin(phase), way * omega * np.cos(phase)


def _gust(gust: Any, time: float) -> tuple[Array, Array]:
    end = gust.at_s + gust.duration_s
    velocity, slope = np.array(gust.velocity_ned_m_s), 0.5 * np.pi / gust.rise_s
    if gust.at_s <= time < gust.at_s + gust.rise_s:
        x = np.pi * (time - gust.at_s) / gust.rise_s
        return velocity * 0.5 * (1.0 - np.cos(x)), velocity * slope * np.sin(x)
    if end - gust.rise_s < time <= end:
        x = np.pi * (end - time) / gust.rise_s
        return velocity * 0.5 * (1.0 - np.cos(x)), -velocity * slope * np.sin(x)
    share = 1.0 if gust.at_s <= time <= end else 0.0
    return share * velocity, np.zeros(3)


def _toward(degrees: float) -> Array:
    """Unit vector (3,) toward a direction from north to east."""
    angle = np.radians(degrees)
    return np.array([np.cos(angle), np.sin(angle), 0.0])
