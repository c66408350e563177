"""Progress of a run on the terminal."""

import sys
import time
from typing import TYPE_CHECKING

from uvms_core.signals import to_seconds

if TYPE_CHECKING:
    from rich.progress import Progress

REFRESH_S = 0.2
LINE_S = 5.0


class PaceMeter:
    """Simulated time over wall time, from the first stamp after 0 on."""

    def __init__(self) -> None:
        self._began: tuple[float, int] | None = None

    def at(self, stamp: int) -> float | None:
        """The pace up to this stamp in ns; None at the start."""
        if self._began is None:
            if stamp > 0:
                self._began = time.monotonic(), stamp
            return None
        began, first = self._began
        if stamp <= first:
            return None
        return to_seconds(stamp - first) / max(time.monotonic() - began, 1e-9)


class ProgressLine:
    """A bar on a terminal, a line every few seconds elsewhere; nothing where it is quiet."""

    def __init__(self, end: int, quiet: bool = False) -> None:
        self._end = end
        self._quiet = quiet
        self._shown = 0.0
        self._pace = PaceMeter()
        self._bar = _bar() if sys.stderr.isatty() and not quiet else None
        if self._bar is not None:
            self._bar.start()
            self._task = self._bar.add_task("run", total=to_seconds(end), speed="", note="")

    def show(self, stamp: int, note: str) -> None:
        """Show how far the run is; cheap when called often."""
        if self._quiet:
            return
        now = time.monotonic()
        pace = self._pace.at(stamp)
        if now - self._shown < (REFRESH_S if self._bar is not None else LINE_S):
            return
        self._shown = now
        self._print(stamp, "" if pace is None else f"{pace:5.1f}x real time", note)

    def end(self) -> None:
        """Stop the bar, leaving its last state on the screen."""
        if self._bar is not None:
            self._bar.stop()

    def _print(self, stamp: int, speed: str, note: str) -> None:
        if self._bar is not None:
            self._bar.update(self._task, completed=to_seconds(stamp), speed=speed, note=note)
        elif stamp > 0:
            done = f"{to_seconds(stamp):7.1f} of {to_seconds(self._end):.10g} s"
            print(f"{done}  {speed}  {note}".rstrip(), file=sys.stderr, flush=True)


def _bar() -> "Progress":
    from rich.console import Console  # only a terminal needs it
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    return Progress(
        TextColumn("{task.completed:6.1f} of {task.total:.10g} s"),
        BarColumn(),
        TextColumn("{task.fields[speed]}"),
        TextColumn("{task.fields[note]}"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=False,
    )
