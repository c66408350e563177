"""Electrical power of a thruster by its thrust, as a table or by the theory of the actuator disc.

What a drive (ESC with motor and propeller) takes from its supply while it gives a thrust at rest
(bollard pull). An ideal disc of area A takes P = |T|^1.5 / sqrt(2 rho A) there (Rankine, Froude;
Newman, Marine Hydrodynamics, sec. 2); the efficiency is that of propeller, motor and drive against
it.
"""

from functools import lru_cache
from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from uvms_core.signals import Array
from uvms_core.vehicle.parts import Part

Numbers = tuple[float, ...]


class ThrusterPower(Part):
    """Power by thrust: either a table or an actuator disc."""

    thrust_n: Numbers = Field(
        default=(),
        description="of a table: thrusts in rising order, astern negative, N; 0 must be among them",
    )
    power_w: Numbers = Field(
        default=(),
        description="of a table: electrical power at each thrust, W; in between it is interpolated,"
        " beyond its ends it grows with |T|^1.5",
    )
    diameter_m: float | None = Field(
        default=None, gt=0.0, description="of an actuator disc: diameter of the propeller, m"
    )
    efficiency: float | None = Field(
        default=None,
        gt=0.0,
        le=1.0,
        description="of an actuator disc: the ideal disc's power over the electrical power,"
        " propeller, motor and drive together, 0 to 1",
    )

    @model_validator(mode="after")
    def _check(self) -> "ThrusterPower":
        is_table, is_disc = bool(self.thrust_n or self.power_w), self.diameter_m is not None
        if is_table == is_disc or is_disc != (self.efficiency is not None):
            raise ValueError(
                "needs either thrust_n and power_w (a table), or diameter_m and efficiency (an"
                " actuator disc)"
            )
        if is_table:
            self._check_table()
        return self

    def _check_table(self) -> None:
        if len(self.thrust_n) != len(self.power_w) or len(self.thrust_n) < 2:
            raise ValueError(
                f"thrust_n has {len(self.thrust_n)} values and power_w {len(self.power_w)};"
                " needs as many, and at least two"
            )
        thrust, power = np.array(self.thrust_n), np.array(self.power_w)
        if (np.diff(thrust) <= 0.0).any():
            k = int(np.argmax(np.diff(thrust) <= 0.0))
            raise ValueError(f"thrust_n must rise; {thrust[k + 1]:g} N follows {thrust[k]:g} N")
        if 0.0 not in self.thrust_n:
            raise ValueError(f"thrust_n has no 0 between {thrust[0]:g} and {thrust[-1]:g} N")
        if (power < 0.0).any():
            raise ValueError(f"power_w: {power.min():g} W; must be >= 0")
        falls = np.diff(power) * np.where(thrust[1:] > 0.0, 1.0, -1.0) < 0.0
        if falls.any():
            k = int(np.argmax(falls))
            raise ValueError(
                f"power_w goes from {power[k]:g} to {power[k + 1]:g} W where thrust_n goes from"
                f" {thrust[k]:g} to {thrust[k + 1]:g} N; it must rise with the size of the thrust"
            )

    @property
    def is_disc(self) -> bool:
        """Whether it is an actuator disc, whose power goes with |T|^1.5."""
        return self.diameter_m is not None

    def check_within(self, astern_n: float) -> None:
        """ValueError unless it says what a thruster takes that gives this thrust astern, N."""
        if self.thrust_n and astern_n < 0.0 and self.thrust_n[0] == 0.0:
            raise ValueError(
                f"power.thrust_n begins at 0 N, and the thruster gives {astern_n:g} N astern;"
                " needs its power astern as well"
            )
        if self.thrust_n and self.thrust_n[-1] == 0.0:
            raise ValueError("power.thrust_n ends at 0 N; needs the power ahead as well")

    def power(self, thrust: ArrayLike, water_density_kg_m3: float) -> Array:
        """Electrical power, W, of thrusts of any shape, N."""
        t = np.asarray(thrust, dtype=float)
        if self.diameter_m is None or self.efficiency is None:
            return self._of_table(t)
        area, size = 0.25 * pi * self.diameter_m**2, np.abs(t)
        ideal = size * np.sqrt(size) / sqrt(2.0 * water_density_kg_m3 * area)
        return ideal / self.efficiency

    def _of_table(self, thrust: Array) -> Array:
        points, values = _arrays(self.thrust_n, self.power_w)
        power = np.interp(thrust, points, values)
        beyond = (thrust < points[0]) | (thrust > points[-1])
        if not beyond.any():
            return power
        end = np.where(thrust > 0.0, points[-1], points[0])
        grown = np.divide(thrust, end, out=np.ones_like(thrust), where=beyond) ** 1.5
        return power * np.where(beyond, grown, 1.0)


@lru_cache(maxsize=256)
def _arrays(thrust: Numbers, power: Numbers) -> tuple[Array, Array]:
    """The points of a table, made once; thrusters of one kind share them."""
    return np.array(thrust), np.array(power)
