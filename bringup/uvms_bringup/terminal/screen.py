"""The terminal during a run: a live panel where there is one, else a line every few seconds."""

import sys
import time
from collections.abc import Callable

from uvms_bringup.progress import LINE_S, PaceMeter
from uvms_bringup.terminal.glance import Glance
from uvms_bringup.terminal.line import line
from uvms_bringup.terminal.listener import Listener
from uvms_bringup.terminal.live_panel import LivePanel, can_draw
from uvms_core.signals import to_seconds

REFRESH_S = 0.25
"""Wall time between two pictures of the panel."""


class Screen:
    """Shows a run while it goes on; a context manager that leaves a clean screen.

    Args:
        title: of the panel.
        end: of the run, ns.
        listener: hears the run's messages; None: nothing is shown.
    """

    def __init__(self, title: str, end: int, listener: Listener | None) -> None:
        self._end, self._listener = to_seconds(end), listener
        self._pace = PaceMeter()
        self._drawn = -REFRESH_S
        self._phase, self._stamp = "", 0
        self._live = LivePanel(title) if listener is not None and can_draw() else None

    def __enter__(self) -> "Screen":
        if self._live is not None:
            self._live.start()
        return self

    def __exit__(self, *_: object) -> None:
        if self._live is not None:
            self._live.stop()

    def show(self, stamp: int, phase: str) -> None:
        """Show how far the run is, ns, and what it is at; cheap when called often.

        What stands before a colon is shown as soon as it changes, since the run may stand still.
        """
        if self._listener is None:
            return
        self._stamp, pace = stamp, self._pace.at(stamp)
        is_news = _head(phase) != _head(self._phase)
        self._phase = phase
        if self._live is not None:
            if is_news or self._is_due(REFRESH_S):
                self._live.draw(self._glance(self._listener, pace))
        elif stamp > 0 and self._is_due(LINE_S):
            print(line(self._glance(self._listener, pace)), file=sys.stderr, flush=True)

    def wait(self, lack: Callable[[], str]) -> None:
        """The run waits for what `lack` says, and no time passes."""
        if self._live is not None and self._listener is not None and self._is_due(REFRESH_S):
            self._phase = f"waiting for: {lack()}"
            self._live.draw(self._glance(self._listener, None))

    def _is_due(self, period: float) -> bool:
        now = time.monotonic()
        if now - self._drawn < period:
            return False
        self._drawn = now
        return True

    def _glance(self, listener: Listener, pace: float | None) -> Glance:
        measured = listener.measured(self._stamp)
        return Glance(to_seconds(self._stamp), self._end, pace, self._phase, measured)


def _head(phase: str) -> str:
    return phase.partition(":")[0]
