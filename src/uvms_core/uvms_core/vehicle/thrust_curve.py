"""Thrust by command, as a table or a polynomial, with its inverse.

A drive (an ESC with motor and propeller) is commanded by a number c from -1, full astern, to 1,
full ahead; for pulse widths of 1100 to 1900 microseconds c = (width - 1500) / 400. Below a share of
the full command, the dead zone, it gives no thrust; where it begins to turn the thrust may jump to
a least value, so that smaller ones cannot be had. Both are published for most thrusters. The curve
is that of a vehicle at rest (bollard pull).
"""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import Field, model_validator

from uvms_core.signals import Array
from uvms_core.vehicle.parts import Part

SAMPLES = 256
"""Pieces into which each half of a polynomial is cut: a square one is met to 2e-6 of its thrust."""

DeadZone = Annotated[
    float,
    Field(
        ge=0.0,
        lt=1.0,
        description="share of the full command up to which there is no thrust, 0 to 1; 0: none",
    ),
]

Numbers = tuple[float, ...]


@dataclass(frozen=True, eq=False)
class ThrustTable:
    """A curve as points: each half's commands, and thrusts that grow in size from point to point.

    Attributes:
        astern: commands (k,) and thrusts (k,), N, from full astern to where thrust begins.
        ahead: the same from where thrust begins to full ahead.
    """

    astern: tuple[Array, Array]
    ahead: tuple[Array, Array]

    @property
    def least_n(self) -> tuple[float, float]:
        """Smallest thrust but none, astern (negative or 0) and ahead, N."""
        return float(self.astern[1][-1]), float(self.ahead[1][0])

    def thrust(self, command: Array | float) -> Array:
        """Thrust, N, of commands from -1 to 1; those beyond are taken for full ones."""
        c = np.asarray(command, dtype=float)
        backs = (c <= self.astern[0][-1]) & (c < 0.0)
        pushes = (c >= self.ahead[0][0]) & (c > 0.0)
        astern = np.where(backs, np.interp(c, *self.astern), 0.0)
        return np.where(pushes, np.interp(c, *self.ahead), astern)

    def command(self, thrust: Array | float) -> Array:
        """Command of a thrust that the drive can give, N; 0 for none."""
        t = self.reachable(thrust)
        astern = np.where(t < 0.0, np.interp(t, *self.astern[::-1]), 0.0)
        return np.where(t > 0.0, np.interp(t, *self.ahead[::-1]), astern)

    def reachable(self, thrust: Array | float) -> Array:
        """The thrust nearest to a wanted one, N, that some command gives."""
        return nearest_reachable(thrust, *self.least_n).clip(self.astern[1][0], self.ahead[1][-1])


def nearest_reachable(thrust: Array | float, astern: Array | float, ahead: Array | float) -> Array:
    """The thrusts nearest to wanted ones, N, where the smallest but none are these."""
    t = np.asarray(thrust, dtype=float)
    t = np.where((t > 0.0) & (t < ahead), np.where(t > 0.5 * ahead, ahead, 0.0), t)
    return np.where((t < 0.0) & (t > astern), np.where(t < 0.5 * astern, astern, 0.0), t)


class ThrustCurve(Part):
    """Thrust by command: either a table or two polynomials."""

    command: Numbers = Field(
        default=(),
        description="of a table: commands in rising order, from -1 (full astern; 0 for a thruster"
        " that does not reverse) to 1 (full ahead)",
    )
    thrust_n: Numbers = Field(
        default=(),
        description="of a table: thrust at each command, N; in between it is interpolated",
    )
    ahead_n: Numbers = Field(
        default=(),
        description="of polynomials: [a0, a1, a2, ...], thrust ahead is a0 + a1 s + a2 s^2 + ... N,"
        " with s from 0 at the end of the dead zone to 1 at the full command; a0 is the least"
        " thrust that it gives",
    )
    astern_n: Numbers = Field(
        default=(), description="the same astern, as positive numbers; empty: it does not reverse"
    )

    @classmethod
    def straight(cls, astern_n: float, ahead_n: float) -> "ThrustCurve":
        """Thrust in proportion to the command, in each direction by its own limit, N."""
        if astern_n == 0.0:
            return cls(command=(0.0, 1.0), thrust_n=(0.0, ahead_n))
        return cls(command=(-1.0, 0.0, 1.0), thrust_n=(astern_n, 0.0, ahead_n))

    @model_validator(mode="after")
    def _check(self) -> "ThrustCurve":
        is_table, is_polynomial = bool(self.command or self.thrust_n), bool(self.ahead_n)
        if is_table == is_polynomial or (is_table and self.astern_n):
            raise ValueError("needs either command and thrust_n, or ahead_n and astern_n")
        if is_table:
            self._check_table()
        for name in ("ahead_n", "astern_n"):
            if getattr(self, name):
                _check_polynomial(name, np.array(getattr(self, name)))
        return self

    def _check_table(self) -> None:
        if len(self.command) != len(self.thrust_n) or len(self.command) < 2:
            raise ValueError(
                f"command has {len(self.command)} values and thrust_n {len(self.thrust_n)};"
                " needs as many, and at least two"
            )
        command, thrust = np.array(self.command), np.array(self.thrust_n)
        if command[0] not in (-1.0, 0.0) or command[-1] != 1.0 or (np.diff(command) <= 0.0).any():
            raise ValueError("command must rise from -1, or 0, to 1")
        if (np.diff(thrust) < 0.0).any():
            k = int(np.argmax(np.diff(thrust) < 0.0))
            raise ValueError(
                f"thrust_n falls from {thrust[k]:g} to {thrust[k + 1]:g} N where the command rises"
                f" from {command[k]:g} to {command[k + 1]:g}; it must rise with the command"
            )
        at_rest = float(np.interp(0.0, command, thrust))
        if abs(at_rest) > 1e-9 * float(np.abs(thrust).max()):
            raise ValueError(f"thrust_n is {at_rest:g} N without a command; it must be 0 there")
        flat = (np.diff(thrust) == 0.0) & (thrust[1:] != 0.0)
        if flat.any():
            k = int(np.argmax(flat))
            raise ValueError(
                f"thrust_n stays at {thrust[k]:g} N where the command rises from {command[k]:g} to"
                f" {command[k + 1]:g}; only at 0 N it may"
            )
        if not thrust[-1] > 0.0:
            raise ValueError("thrust_n: no thrust at the full command ahead")

    @property
    def ends_n(self) -> tuple[float, float]:
        """Thrust at the full command astern (negative, or 0) and ahead, N."""
        if self.ahead_n:
            return -sum(self.astern_n) + 0.0, sum(self.ahead_n)
        return min(self.thrust_n[0], 0.0), self.thrust_n[-1]

    def table(self, dead_zone: float) -> ThrustTable:
        """The curve with no thrust up to a share of the full command.

        Raises ValueError where the least thrust of a polynomial has no dead zone before it.
        """
        if self.ahead_n:
            if dead_zone == 0.0 and max(self.ahead_n[0], *self.astern_n[:1]) > 0.0:
                raise ValueError(
                    f"curve: gives {self.ahead_n[0]:g} N or more as soon as there is a command;"
                    " needs a dead_zone > 0 before that, or a first value of 0"
                )
            command, thrust = _sampled(self.astern_n, dead_zone)
            return ThrustTable((-command[::-1], -thrust[::-1]), _sampled(self.ahead_n, dead_zone))
        command, thrust = np.array(self.command), np.array(self.thrust_n)
        back, least = _half(-command[::-1], -thrust[::-1], dead_zone)
        return ThrustTable((-back[::-1], -least[::-1]), _half(command, thrust, dead_zone))


def _check_polynomial(name: str, coefficients: Array) -> None:
    thrust = _polynomial(coefficients, np.linspace(0.0, 1.0, SAMPLES + 1))
    if coefficients[0] < 0.0:
        raise ValueError(f"{name}: its first value, the least thrust, is {coefficients[0]:g} N < 0")
    if (np.diff(thrust) <= 0.0).any():
        s = int(np.argmax(np.diff(thrust) <= 0.0)) / SAMPLES
        raise ValueError(
            f"{name}: the thrust does not rise with the command at s = {s:.3g}, where it is"
            f" {thrust[round(s * SAMPLES)]:g} N"
        )


def _polynomial(coefficients: Array, s: Array) -> Array:
    return np.asarray(np.polynomial.polynomial.polyval(s, coefficients))


def _sampled(coefficients: Numbers, dead_zone: float) -> tuple[Array, Array]:
    """Commands and thrusts of one half of a polynomial curve, both as sizes."""
    if not coefficients:
        return np.array([dead_zone, 1.0]), np.zeros(2)
    s = np.linspace(0.0, 1.0, SAMPLES + 1)
    return dead_zone + (1.0 - dead_zone) * s, _polynomial(np.array(coefficients), s)


def _half(command: Array, thrust: Array, dead_zone: float) -> tuple[Array, Array]:
    """The half of a table ahead that gives thrust beyond the dead zone, from its edge on."""
    if not thrust[-1] > 0.0:
        return np.array([dead_zone, 1.0]), np.zeros(2)
    begin = max(dead_zone, float(command[np.flatnonzero(thrust > 0.0)[0] - 1]), 0.0)
    after = command > begin
    edge = float(np.interp(begin, command, thrust))
    return np.append(begin, command[after]), np.append(edge, thrust[after])
