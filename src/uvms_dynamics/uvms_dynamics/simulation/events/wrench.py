"""Somebody pushes the vehicle from outside."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.errors import ConfigError
from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.parts import Vector3
from uvms_dynamics.simulation.events.event import Effects, LastingEvent
from uvms_dynamics.simulation.integrator import PUSH

FRAMES = {"world": 0, "body": PUSH // 2}


class Push(Config):
    """A constant force and moment on the hull at the body origin."""

    force_n: Vector3 = Field((0.0, 0.0, 0.0), description="force, N")
    moment_nm: Vector3 = Field((0.0, 0.0, 0.0), description="moment about the body origin, N m")
    frame: Literal["world", "body"] = Field(
        "world",
        description="axes of both: `world` is map_ned (they keep their direction), `body` is"
        " base_link_fsd (they turn with the vehicle)",
    )

    @property
    def wrench(self) -> Array:
        """(12,) as the integrator takes it."""
        result = np.zeros(PUSH)
        first = FRAMES[self.frame]
        result[first : first + PUSH // 2] = *self.force_n, *self.moment_nm
        return result


def nearest_step(time_s: float, step: int) -> int:
    """The plant step, ns, that is nearest to a time, s."""
    return (to_nanoseconds(time_s) + step // 2) // step * step


class WrenchEvent(LastingEvent):
    """A wrench acts on the hull for a while: from plant step to plant step, with its impulse."""

    between_ticks: ClassVar[bool] = True

    wrench: Push = Field(description="force, moment and their axes")

    def check(self, vehicle: Vehicle) -> None:
        """Any vehicle can be pushed."""

    def check_times(self, step: int, period: int) -> None:
        """Whether it lasts for a plant step."""
        if self.until_s is None:
            return
        begin = nearest_step(self.at_s, step)
        if nearest_step(self.until_s, step) == begin:
            raise ConfigError(
                f"until_s {self.until_s:g}: the push from {self.at_s:g} s on would be over at the"
                f" plant step at which it begins, {to_seconds(begin):g} s (plant.step_s ="
                f" {to_seconds(step):g} s); the shortest lasts until {to_seconds(begin + step):g} s"
            )

    def acting(self, step: int) -> Array:
        """The wrench (12,) between the plant steps, of `step` ns, nearest to begin and end.

        Times its duration it is the impulse that was asked for, whatever the rounding.
        """
        wrench = self.wrench.wrench
        if self.until_s is None:
            return wrench
        asked = to_nanoseconds(self.until_s) - to_nanoseconds(self.at_s)
        return wrench * (asked / (nearest_step(self.until_s, step) - nearest_step(self.at_s, step)))

    def begin(self, effects: Effects) -> None:
        """The wrench acts, besides those of other events."""
        effects.push(self.acting(effects.step))

    def end(self, effects: Effects) -> None:
        """It acts no more."""
        effects.stop_pushing(self.acting(effects.step))

    def text(self) -> str:
        """In words."""
        force = ", ".join(f"{value:g}" for value in self.wrench.force_n)
        moment = ", ".join(f"{value:g}" for value in self.wrench.moment_nm)
        return f"wrench ({force}) N, ({moment}) N m in {self.wrench.frame} axes"
