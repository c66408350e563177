"""The pace of a run: lockstep or real time."""

from dataclasses import dataclass

from uvms_bringup.errors import RunError


@dataclass(frozen=True)
class Pace:
    """`lockstep` (repeatable, as fast as the machine) or `realtime` with a factor."""

    name: str = "lockstep"
    factor: float = 1.0

    @classmethod
    def parse(cls, text: str) -> "Pace":
        """A pace from `lockstep`, `realtime` or `realtime:FACTOR`."""
        name, _, factor = text.partition(":")
        if name == "lockstep" and not factor:
            return cls()
        try:
            pace = cls(name, float(factor or 1.0))
        except ValueError:
            pace = cls("", 0.0)
        if pace.name != "realtime" or not 0.0 < pace.factor <= 1000.0:
            raise RunError(
                f"pace {text!r}: choose lockstep, realtime, or realtime:FACTOR"
                " with 0 < FACTOR <= 1000"
            )
        return pace

    def __str__(self) -> str:
        return self.name if self.name == "lockstep" else f"{self.name}:{self.factor:g}"
