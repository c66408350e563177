"""Progress of a run on the terminal."""

import sys
import time
from typing import TYPE_CHECKING

from uvms_core.signals import to_seconds

if TYPE_CHECKING:
    from rich.progress import Progress

REFRESH_S = 0.2
LINE_S = 5.0


class ProgressLine:
    """A bar on a terminal, a line every few seconds elsewhere; nothing where it is quiet."""

    def __init__(self, end: int, quiet: bool = False) -> None:
        self._end = end
        self._quiet = quiet
        self._shown = 0.0
        self._began: tuple[float, int] | None = None
        self._bar = _bar() if sys.stderr.isatty() and not quiet else None
        if self._bar is not None:
            self._bar.start()
            self._task = self._bar.add_task("run", total=to_seconds(end), speed="", note="")

    def show(self, stamp: int, note: str) -> None:
        """Show how far the run is; cheap when called often."""
        if self._quiet:
            return
        now = time.monotonic()
        if self._began is None and stamp > 0:
            self._began = now, stamp
        if now - self._shown < (REFRESH_S if self._bar is not None else LINE_S):
            return
        self._shown = now
        self._print(stamp, note)

    def end(self) -> None:
        """Stop the bar, leaving its last state on the screen."""
        if self._bar is not None:
            self._bar.stop()

    def _print(self, stamp: int, note: str) -> None:
        speed = self._speed(stamp)
        if self._bar is not None:
            self._bar.update(self._task, completed=to_seconds(stamp), speed=speed, note=note)
        elif stamp > 0:
            done = f"{to_seconds(stamp):7.1f} of {to_seconds(self._end):.0f} s"
            print(f"{done}  {speed}  {note}".rstrip(), file=sys.stderr, flush=True)

    def _speed(self, stamp: int) -> str:
        if self._began is None or stamp <= self._began[1]:
            return ""
        elapsed = time.monotonic() - self._began[0]
        return f"{to_seconds(stamp - self._began[1]) / max(elapsed, 1e-9):5.1f}x real time"


def _bar() -> "Progress":
    from rich.console import Console  # only a terminal needs it
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    return Progress(
        TextColumn("{task.completed:6.1f} of {task.total:.0f} s"),
        BarColumn(),
        TextColumn("{task.fields[speed]}"),
        TextColumn("{task.fields[note]}"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=False,
    )
