"""What a terminal shows of a run at one moment, whoever draws it; None: nobody has said it yet."""

from dataclasses import dataclass

from uvms_core import diagnostics

LEVELS = {
    diagnostics.OK: "ok",
    diagnostics.WARN: "WARN",
    diagnostics.ERROR: "ERROR",
    diagnostics.STALE: "STALE",
}
"""Words for the levels of /diagnostics."""


@dataclass(frozen=True)
class Bounded:
    """A value and how large its magnitude may become, both in `unit`."""

    value: float | None
    limit: float
    unit: str

    @property
    def is_exceeded(self) -> bool:
        """Whether the value is known and beyond its limit."""
        return self.value is not None and abs(self.value) > self.limit


@dataclass(frozen=True)
class Thruster:
    """Thrust of one thruster and its limits, N."""

    name: str
    thrust: float | None
    astern: float  # negative
    ahead: float
    is_saturated: bool = False

    @property
    def share(self) -> float:
        """Thrust as a share of the limit in its direction, -1 to 1; 0 where it is not known."""
        if not self.thrust:
            return 0.0
        limit = self.ahead if self.thrust > 0.0 else -self.astern
        return max(-1.0, min(1.0, self.thrust / limit)) if limit > 0.0 else 0.0


@dataclass(frozen=True)
class Push:
    """Magnitudes of one part of the disturbance: force, N, and moment, N m."""

    force: float
    moment: float


@dataclass(frozen=True)
class Battery:
    """What a battery has left and what is taken from it."""

    share: float  # of its charge, 0 to 1; NaN where it is not known
    voltage: float  # V
    power: float  # W, that is taken


@dataclass(frozen=True)
class Health:
    """The worst that a node has said about itself: its level, its name and its text."""

    level: int  # of uvms_core.diagnostics
    node: str = ""  # "": all nodes are well
    text: str = ""

    @property
    def words(self) -> str:
        """Level, node and text in a line."""
        return f"{LEVELS.get(self.level, 'ERROR')} {self.node}: {self.text}" if self.node else "ok"


@dataclass(frozen=True)
class Measured:
    """What the run's messages say; the state is the estimated one, as the controller knows it."""

    tool: Bounded  # tool from where the plan wants it, mm
    roll: Bounded  # deg
    pitch: Bounded  # deg
    thrusters: tuple[Thruster, ...] = ()
    restoring: Push | None = None
    coupling: Push | None = None
    external: Push | None = None
    battery: Battery | None = None
    health: Health | None = None
    events: tuple[tuple[float, str], ...] = ()  # time, s, and text; the last ones


@dataclass(frozen=True)
class Glance:
    """One moment of a run.

    Args:
        time: simulated, s.
        end: when the run ends, s.
        pace: simulated time over wall time so far.
        phase: what the run is at, in words.
        measured: what its messages say.
    """

    time: float
    end: float
    pace: float | None
    phase: str
    measured: Measured

    @property
    def share(self) -> float:
        """How much of the run is done, 0 to 1."""
        return min(self.time / self.end, 1.0) if self.end > 0.0 else 0.0

    @property
    def left_s(self) -> float | None:
        """Wall time that the rest takes at this pace, s."""
        return (self.end - self.time) / self.pace if self.pace else None
