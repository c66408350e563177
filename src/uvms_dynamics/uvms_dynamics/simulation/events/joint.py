"""A joint sticks, or comes free."""

from pydantic import Field

from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.events.event import Effects, Event, check_name


class JointEvent(Event):
    """A joint keeps its angle exactly, or moves again."""

    joint: str = Field(description="name of the joint")
    stuck: bool = Field(description="true: it keeps its angle from now on; false: it moves again")

    def check(self, vehicle: Vehicle) -> None:
        """Its name."""
        check_name("joint", self.joint, vehicle.joint_names)

    def begin(self, effects: Effects) -> None:
        """The joint's degree of freedom goes or comes back."""
        effects.set_joint(self.joint, self.stuck)

    def text(self) -> str:
        """In words."""
        return f"joint {self.joint}: {'stuck' if self.stuck else 'free'}"
