"""How the water moves, as a scenario describes it: the sum of everything that is given.

Directions are those in which the water, or a wave, goes: 0 north, 90 east, degrees.
"""

from typing import Annotated

from pydantic import Field, model_validator

from uvms_core.config import Config
from uvms_core.start import DEEPEST_M
from uvms_dynamics.simulation.water.airy import highest_wave, wave_length

FASTEST_M_S = 100.0
"""Of vehicle or water, m/s or rad/s: several times the fastest that moves under water."""
LATEST_S = 1e6
"""Of what happens in a run, and of periods, s: ten days hold all tides."""
SHORTEST_PERIOD_S = 1.0
"""Of currents and waves, s: twenty of the longest plant steps. A wave of 1 s is 1.6 m long; shorter
ones are no longer than a vehicle, whose bodies take the flow at their centres for all of it."""
LONGEST_WAVE_S = 60.0
"""Of waves, s: what is longer, surf beat and tides, is a current at a vehicle."""
SHALLOWEST_M = 0.1
"""Of water with waves, m: no vehicle floats in less."""
SHORTEST_RISE_S = 0.1
"""Of a gust, s: two of the longest plant steps; a jump would be an infinite acceleration."""

Speed = Annotated[float, Field(ge=-FASTEST_M_S, le=FASTEST_M_S)]
Turns = Annotated[float, Field(ge=-720.0, le=720.0)]
"""An attitude, direction or phase in degrees: more than two turns is a mistake."""
Time = Annotated[float, Field(ge=0.0, le=LATEST_S)]
Period = Annotated[float, Field(ge=SHORTEST_PERIOD_S, le=LATEST_S)]


class Turning(Config):
    """A current of constant speed whose direction turns, as a tide's does."""

    speed_m_s: float = Field(0.0, ge=0.0, le=FASTEST_M_S, description="speed, m/s; 0: none")
    period_s: Period = Field(120.0, description="time of a whole turn, clockwise, s")
    start_deg: Turns = Field(0.0, description="direction at t = 0, from north to east, degrees")


class Gust(Config):
    """A current that rises along half a cosine, lasts and falls in the same way."""

    at_s: Time = Field(description="when it begins to rise, s")
    duration_s: Time = Field(description="from the beginning to the end, s")
    velocity_ned_m_s: tuple[Speed, Speed, Speed] = Field(
        description="velocity at its height in map_ned, m/s"
    )
    rise_s: float = Field(
        1.0, ge=SHORTEST_RISE_S, description="time that it rises, and falls, s; ≤ duration_s / 2"
    )

    @model_validator(mode="after")
    def _has_time_to_rise(self) -> "Gust":
        if self.rise_s > 0.5 * self.duration_s:
            raise ValueError(
                f"rise_s: {self.rise_s:g} s does not fit twice into duration_s ="
                f" {self.duration_s:g} s; allowed: at most {0.5 * self.duration_s:g} s"
            )
        return self


class Oscillating(Config):
    """A current a sin(2 pi t / T + phase) to and fro along one horizontal direction."""

    amplitude_m_s: float = Field(ge=0.0, le=FASTEST_M_S, description="greatest speed, m/s")
    period_s: Period = Field(description="period, s")
    direction_deg: Turns = Field(0.0, description="direction, from north to east, degrees")
    phase_deg: Turns = Field(0.0, description="phase at t = 0, degrees")


class Wave(Config):
    """A linear (Airy) wave: surface (H / 2) cos(k x - omega t + phase), x along its direction."""

    height_m: float = Field(
        ge=0.0, description="from trough to crest, m; at most that of a breaking wave (Miche)"
    )
    period_s: float = Field(
        ge=SHORTEST_PERIOD_S, le=LONGEST_WAVE_S, description="period over ground, s"
    )
    water_depth_m: float = Field(
        ge=SHALLOWEST_M, le=DEEPEST_M, description="depth of the water, which is level, m"
    )
    direction_deg: Turns = Field(
        0.0, description="direction in which it runs, from north to east, degrees"
    )
    phase_deg: Turns = Field(
        0.0, description="phase at t = 0 above the origin of map_ned, degrees; 0: crest"
    )

    @model_validator(mode="after")
    def _does_not_break(self) -> "Wave":
        highest = highest_wave(self.period_s, self.water_depth_m)
        if self.height_m > highest:
            length = wave_length(self.period_s, self.water_depth_m)
            raise ValueError(
                f"height_m: a wave of {self.height_m:g} m breaks: with period_s ="
                f" {self.period_s:g} s in water_depth_m = {self.water_depth_m:g} m it is"
                f" {length:.3g} m long and at most {highest:.3g} m high (0.142 L tanh k h)"
            )
        return self


class CurrentConfig(Config):
    """Motion of the water: the sum of what is given."""

    constant_ned_m_s: tuple[Speed, Speed, Speed] = Field(
        (0.0, 0.0, 0.0), description="the part that is constant, in map_ned, m/s"
    )
    turning: Turning = Field(Turning(), description="a current whose direction turns")
    gusts: tuple[Gust, ...] = Field((), description="currents that come and go once")
    oscillating: tuple[Oscillating, ...] = Field((), description="currents to and fro")
    waves: tuple[Wave, ...] = Field((), description="linear waves on the surface")

    @model_validator(mode="after")
    def _has_one_bottom(self) -> "CurrentConfig":
        for i, wave in enumerate(self.waves):
            if wave.water_depth_m != self.waves[0].water_depth_m:
                raise ValueError(
                    f"waves.{i}.water_depth_m: {wave.water_depth_m:g} m, but"
                    f" {self.waves[0].water_depth_m:g} m for waves.0: the sea has one depth"
                )
        return self
