"""Notices when a node is silent, so that it says what it waits for."""

from uvms_core import diagnostics

LOOK_S = 0.25
"""How often a node looks after itself, s of wall time."""
SILENT_S = 0.6
"""Wall time without a tick after which a node says so, and between two times that it does: with
`LOOK_S` and the executor's own sleep that is once a second at least."""
PATIENCE_S = 10.0
"""Wall time without a tick that is nothing unusual: nodes start, and kernels are compiled."""


class Watchdog:
    """Wall times of a node: of its last tick, and of what it last said; monotonic, s."""

    def __init__(self, wall: float) -> None:
        self.due = wall
        self._silent_since = wall
        self._said = wall
        self._ticked = False

    def is_due(self, wall: float) -> bool:
        """Whether the node is to look after itself."""
        return wall >= self.due

    def ticked(self) -> None:
        """The node has a tick."""
        self._ticked = True

    def said(self, wall: float) -> None:
        """The node has reported."""
        self._said = wall

    def silent_level(self, wall: float) -> int | None:
        """Level at which to say that the node is silent; None: it is not, or has just said so."""
        if self._ticked:
            self._ticked, self._silent_since = False, wall
        silent = wall - self._silent_since
        if min(silent, wall - self._said) < SILENT_S:
            return None
        return diagnostics.OK if silent < PATIENCE_S else diagnostics.WARN
