"""Progress of a campaign on the terminal: how many runs, how fast, and how long it will take."""

import sys
import time
from types import TracebackType

LINE_S = 5.0


class CampaignProgress:
    """A bar on a terminal, a line every few seconds elsewhere; a context manager.

    Args:
        total: runs to make.
        kept: of these, how many are there already.
        failed: of those that are there, how many failed.
    """

    def __init__(self, total: int, kept: int, failed: int = 0) -> None:
        self._total, self._kept = total, kept
        self._done, self._failed = kept, failed
        self._began = self._shown = time.monotonic()
        self._bar = _bar() if sys.stderr.isatty() else None

    def __enter__(self) -> "CampaignProgress":
        if self._bar is not None:
            self._bar.start()
            self._task = self._bar.add_task("", total=self._total, completed=self._done, text="")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._bar is not None:
            self._bar.stop()

    def add(self, failed: bool) -> None:
        """One more run has ended; one of a baseline does not count as failed."""
        self._done += 1
        self._failed += failed
        if self._bar is not None:
            self._bar.update(self._task, completed=self._done, text=self._text())
        elif time.monotonic() - self._shown >= LINE_S:
            self._shown = time.monotonic()
            line = f"{self._done:6d} of {self._total} runs  {self._text()}"
            print(line, file=sys.stderr, flush=True)

    def _text(self) -> str:
        made, seconds = self._done - self._kept, max(time.monotonic() - self._began, 1e-9)
        left = (self._total - self._done) * seconds / made
        return f"{rate(made / seconds)}  {clock(left)} left  {self._failed} failed"


def rate(per_second: float) -> str:
    """Runs per second, or per minute where they take long."""
    if per_second >= 0.5:
        return f"{per_second:.1f} runs/s"
    return f"{60.0 * per_second:.1f} runs/min"


def clock(seconds: float) -> str:
    """Hours, minutes and seconds."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def _bar():
    from rich.console import Console  # only a terminal needs it
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    return Progress(
        MofNCompleteColumn(),
        TextColumn("runs"),
        BarColumn(),
        TextColumn("{task.fields[text]}"),
        console=Console(stderr=True),
    )
