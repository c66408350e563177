"""The panel on a terminal, drawn again and again in the same place."""

import os
import sys
from typing import TYPE_CHECKING, TextIO

from uvms_bringup.terminal.aside import StderrAside
from uvms_bringup.terminal.glance import Glance

if TYPE_CHECKING:
    from rich.console import Console


class LivePanel:
    """The panel on the terminal of stderr; what is written meanwhile stands above it."""

    def __init__(self, title: str) -> None:
        self._title = title

    def start(self) -> None:
        """Begin; nothing is drawn yet."""
        from rich.live import Live

        self._aside = StderrAside()
        self._console = _console(self._aside.console)
        self._live = Live(console=self._console, auto_refresh=False, transient=True)
        self._live.start()

    def draw(self, glance: Glance) -> None:
        """Draw this moment in the place of the one before."""
        from uvms_bringup.terminal.panel import panel

        for text in self._aside.take():
            self._console.out(text, highlight=False)
        is_ascii = self._console.options.ascii_only
        picture = panel(glance, self._title, self._console.width, is_ascii)
        self._live.update(picture, refresh=True)

    def stop(self) -> None:
        """Take the panel away."""
        try:
            self._live.update("", refresh=True)  # one higher than the terminal would leave lines
            self._live.stop()
        finally:
            self._aside.end()


def can_draw() -> bool:
    """Whether there is a terminal, wide enough and with colours, that takes a panel.

    Both streams must go there: what is piped elsewhere is read by a program, or side by side.
    """
    if not (sys.stderr.isatty() and sys.stdout.isatty()) or os.environ.get("NO_COLOR"):
        return False
    from uvms_bringup.terminal.panel import LEAST_COLUMNS

    console = _console(sys.stderr)
    return not console.is_dumb_terminal and console.width >= LEAST_COLUMNS


def _console(file: TextIO) -> "Console":
    from rich.console import Console  # only a terminal needs it

    return Console(file=file)
