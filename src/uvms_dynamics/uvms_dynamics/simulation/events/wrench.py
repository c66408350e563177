"""Somebody pushes the vehicle from outside."""

from typing import Literal

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.signals import Array
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


class WrenchEvent(LastingEvent):
    """A wrench acts on the hull for a while."""

    wrench: Push = Field(description="force, moment and their axes")

    def check(self, vehicle: Vehicle) -> None:
        """Any vehicle can be pushed."""

    def begin(self, effects: Effects) -> None:
        """The wrench acts, besides those of other events."""
        effects.push(self.wrench.wrench)

    def end(self, effects: Effects) -> None:
        """It acts no more."""
        effects.stop_pushing(self.wrench.wrench)

    def text(self) -> str:
        """In words."""
        force = ", ".join(f"{value:g}" for value in self.wrench.force_n)
        moment = ", ".join(f"{value:g}" for value in self.wrench.moment_nm)
        return f"wrench ({force}) N, ({moment}) N m in {self.wrench.frame} axes"
