"""What all events have in common: when they happen, and what they do to a plant."""

from abc import abstractmethod
from collections.abc import Iterable
from typing import ClassVar, Protocol

from pydantic import Field, model_validator

from uvms_core.config import Config
from uvms_core.errors import ConfigError
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.events.load import Load

LATEST_S = 1e6
"""No run is as long."""


class Effects(Protocol):
    """What events can do to a plant."""

    def grasp(self, load: Load) -> None:
        """The last link holds a load from now on."""

    def release(self) -> None:
        """The last link lets go of its load."""

    def set_thruster(self, name: str, share: float, stuck: float) -> None:
        """Thrust is `share` of the command plus `stuck`, N."""

    def set_joint(self, name: str, stuck: bool) -> None:
        """A joint keeps its angle, or moves again."""

    @property
    def step(self) -> int:
        """Integration step of the plant, ns."""

    def push(self, wrench: Array) -> None:
        """A wrench (12,) that acts from now on besides those that act: see `integrator.PUSH`."""

    def stop_pushing(self, wrench: Array) -> None:
        """One that acts no more."""


class Event(Config):
    """One thing that happens to the plant."""

    between_ticks: ClassVar[bool] = False
    """Whether it happens at the nearest plant step, not at the next control tick."""

    at_s: float = Field(ge=0.0, le=LATEST_S, description="when it begins, s")

    @abstractmethod
    def check(self, vehicle: Vehicle) -> None:
        """Raise ConfigError where it does not fit the vehicle; names the field and the choices."""

    def check_times(self, step: int, period: int) -> None:
        """Raise ConfigError where it would be over before it has an effect.

        step, period: of the plant and of its control ticks, ns.
        """
        return None

    @abstractmethod
    def begin(self, effects: Effects) -> None:
        """It happens now."""

    @abstractmethod
    def text(self) -> str:
        """What happens, in words."""

    @property
    def ends_s(self) -> float | None:
        """When it is over, s; None where it does not end by itself."""
        return None

    def end(self, effects: Effects) -> None:
        """It is over now; only where it ends by itself."""
        return None


class LastingEvent(Event):
    """An event that may end by itself."""

    until_s: float | None = Field(
        None, gt=0.0, le=LATEST_S, description="when it ends, s; none: it lasts"
    )

    @model_validator(mode="after")
    def _ends_after_it_began(self) -> "LastingEvent":
        if self.until_s is not None and self.until_s <= self.at_s:
            raise ValueError(f"until_s = {self.until_s:g} must be after at_s = {self.at_s:g}")
        return self

    @property
    def ends_s(self) -> float | None:
        """When it is over, s; None where it lasts."""
        return self.until_s


def check_name(field: str, name: str, choices: Iterable[str]) -> None:
    """ConfigError unless the vehicle has a part of this name."""
    choices = tuple(choices)
    if name not in choices:
        raise ConfigError(f"{field} {name!r}: choose one of {', '.join(choices)}")
