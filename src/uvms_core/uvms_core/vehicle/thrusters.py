"""One thruster of the vehicle: where it is, what it can give, and how it follows a command."""

from functools import lru_cache

from pydantic import Field, model_validator

from uvms_core.signals import Array
from uvms_core.vehicle.parts import Part, UnitVector, Vector3
from uvms_core.vehicle.thrust_curve import DeadZone, ThrustCurve, ThrustTable
from uvms_core.vehicle.thruster_power import ThrusterPower

_WITHIN = 1e-9
"""Relative: a limit printed as the end of the curve is within it."""


class Thruster(Part):
    """A fixed thruster: thrust by command, limits in both directions, lag and slew limit."""

    name: str = Field(
        min_length=1, description="name of the thruster in messages, logs and overrides"
    )
    position_m: Vector3 = Field(description="point where the thrust acts, body frame, m")
    direction: UnitVector = Field(
        description="direction of positive thrust on the vehicle, body frame"
    )
    limit_n: float | None = Field(
        default=None, gt=0.0, description="largest thrust in either direction, N"
    )
    limits_n: tuple[float, float] | None = Field(
        default=None,
        description="instead of `limit_n`, where the directions differ: greatest thrust astern"
        " (negative, or 0 for a thruster that does not reverse) and ahead, N",
    )
    curve: ThrustCurve | None = Field(
        default=None,
        description="thrust by command; none: proportional, up to the limits. Limits may be left"
        " out where there is a curve: they are its ends",
    )
    dead_zone: DeadZone = 0.0
    time_constant_s: float = Field(gt=0.0, description="time constant of the first-order lag, s")
    slew_limit_n_s: float = Field(gt=0.0, description="largest rate of change of the thrust, N/s")
    power: ThrusterPower | None = Field(
        default=None, description="electrical power by thrust; none: not given"
    )

    @model_validator(mode="after")
    def _check_limits(self) -> "Thruster":
        if self.limit_n is not None and self.limits_n is not None:
            raise ValueError(
                "limit_n and limits_n are the same thing: give one of them, or null for the other"
            )
        if self.limit_n is None and self.limits_n is None and self.curve is None:
            raise ValueError("needs limit_n, limits_n or a curve, from which its limits follow")
        if self.limits_n is not None:
            astern, ahead = self.limits_n
            if not astern <= 0.0 < ahead:
                raise ValueError(
                    f"limits_n: {astern:g} and {ahead:g} N; must be astern <= 0 < ahead"
                )
        if self.curve is not None:
            self._check_within_curve(self.curve)
        if self.power is not None:
            self.power.check_within(self.astern_n)
        return self

    def _check_within_curve(self, curve: ThrustCurve) -> None:
        astern, ahead = self.astern_n, self.ahead_n
        least, most = curve.ends_n
        if astern < least * (1.0 + _WITHIN) or ahead > most * (1.0 + _WITHIN):
            raise ValueError(
                f"its limits, {astern:g} to {ahead:g} N, are beyond its curve, which gives"
                f" {least:g} to {most:g} N"
            )
        self.table  # noqa: B018  a dead zone that leaves no thrust is refused here

    @property
    def astern_n(self) -> float:
        """Greatest thrust astern, N, negative or 0."""
        if self.limits_n is not None:
            return self.limits_n[0]
        if self.limit_n is not None:
            return -self.limit_n
        assert self.curve is not None  # the validator holds it
        return self.curve.ends_n[0]

    @property
    def ahead_n(self) -> float:
        """Greatest thrust ahead, N."""
        if self.limits_n is not None:
            return self.limits_n[1]
        if self.limit_n is not None:
            return self.limit_n
        assert self.curve is not None
        return self.curve.ends_n[1]

    @property
    def greatest_n(self) -> float:
        """Greatest thrust in whichever direction has more, N."""
        return max(self.ahead_n, -self.astern_n)

    @property
    def is_ideal(self) -> bool:
        """Whether it gives every thrust within its limits, in proportion to the command."""
        return self.curve is None and self.dead_zone == 0.0

    @property
    def table(self) -> ThrustTable:
        """Thrust by command, and its inverse."""
        curve = self.curve or ThrustCurve.straight(self.astern_n, self.ahead_n)
        return _table(curve, self.dead_zone)

    @property
    def least_n(self) -> tuple[float, float]:
        """Smallest thrust but none, astern (negative) and ahead, N; 0 where there is no gap."""
        return self.table.least_n

    def thrust(self, command: Array | float) -> Array:
        """Thrust in N of commands from -1 (full astern) to 1 (full ahead), within its limits."""
        return self.table.thrust(command).clip(self.astern_n, self.ahead_n)

    def command(self, thrust: Array | float) -> Array:
        """Command, -1 to 1, that gives the reachable thrust nearest to a wanted one, N."""
        return self.table.command(self.reachable(thrust))

    def reachable(self, thrust: Array | float) -> Array:
        """The thrust nearest to a wanted one, N, that the thruster can give and hold."""
        return self.table.reachable(thrust).clip(self.astern_n, self.ahead_n)


@lru_cache(maxsize=256)
def _table(curve: ThrustCurve, dead_zone: float) -> ThrustTable:
    """The table of a curve, made once; thrusters of one kind share it."""
    return curve.table(dead_zone)
