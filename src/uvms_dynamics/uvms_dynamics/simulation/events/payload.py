"""The last link grasps a load, or lets go of it."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.events.event import Effects, Event
from uvms_dynamics.simulation.events.load import Load

RELEASE: Literal["release"] = "release"


def _tag(value: Any) -> str:
    return "<release>" if isinstance(value, str) else "<Load>"


Payload = Annotated[
    Annotated[Load, Tag("<Load>")] | Annotated[Literal["release"], Tag("<release>")],
    Discriminator(_tag),
]


class PayloadEvent(Event):
    """A load is grasped, or released."""

    payload: Payload = Field(
        description="the load that the last link holds from now on, or `release`"
    )

    def check(self, vehicle: Vehicle) -> None:
        """Any vehicle can hold a load."""

    def begin(self, effects: Effects) -> None:
        """The load becomes a part of the last link, or ceases to be one."""
        if isinstance(self.payload, Load):
            effects.grasp(self.payload)
        else:
            effects.release()

    def text(self) -> str:
        """In words."""
        if isinstance(self.payload, Load):
            return f"payload grasped: {self.payload.text()}"
        return "payload released"
