"""A thruster loses thrust, or sticks."""

from pydantic import Field, model_validator

from uvms_core.errors import ConfigError
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.events.event import Effects, Event, check_name


class ThrusterEvent(Event):
    """What becomes of a thruster's commands, until the next event of the same thruster."""

    thruster: str = Field(description="name of the thruster")
    effectiveness: float | None = Field(
        None, ge=0.0, le=1.0, description="share of the command that it realises: 0 dead, 1 whole"
    )
    stuck_at_n: float | None = Field(
        None, description="thrust that it goes to, with its lag, whatever is commanded, N"
    )

    @model_validator(mode="after")
    def _one_of_both(self) -> "ThrusterEvent":
        if (self.effectiveness is None) == (self.stuck_at_n is None):
            raise ValueError("give either effectiveness (0 dead to 1 whole) or stuck_at_n (N)")
        return self

    def check(self, vehicle: Vehicle) -> None:
        """Its name, and the thrust that it can have."""
        check_name("thruster", self.thruster, vehicle.thruster_names)
        drive = vehicle.thrusters[vehicle.thruster_names.index(self.thruster)]
        if self.stuck_at_n is None or drive.astern_n <= self.stuck_at_n <= drive.ahead_n:
            return
        raise ConfigError(
            f"stuck_at_n {self.stuck_at_n:g}: thruster {self.thruster} gives"
            f" {drive.astern_n:g} to {drive.ahead_n:g} N"
        )

    def begin(self, effects: Effects) -> None:
        """Its target changes; the thrust follows with the thruster's lag."""
        if self.stuck_at_n is not None:
            effects.set_thruster(self.thruster, 0.0, self.stuck_at_n)
        elif self.effectiveness is not None:
            effects.set_thruster(self.thruster, self.effectiveness, 0.0)

    def text(self) -> str:
        """In words."""
        if self.stuck_at_n is not None:
            return f"thruster {self.thruster}: stuck at {self.stuck_at_n:g} N"
        return f"thruster {self.thruster}: effectiveness {self.effectiveness:g}"
