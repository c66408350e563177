"""SIGINT and SIGTERM during a run: it ends at the next tick, with its log complete."""

import signal
import threading
from types import TracebackType
from typing import Any

from uvms_bringup.errors import BringupError

EXIT_CODES = {number.name: 128 + number for number in (signal.SIGINT, signal.SIGTERM)}


class Stopped(BringupError):  # noqa: N818 - it is what happened, not a mistake
    """A signal ended the run; `name` is the signal's."""

    def __init__(self, name: str) -> None:
        super().__init__(f"stopped by {name}")
        self.name = name

    @property
    def exit_code(self) -> int:
        """What a shell expects of a program that this signal ended."""
        return EXIT_CODES[self.name]


class SignalWatch:
    """Takes the signals of a run.

    Until `begin` a signal raises Stopped wherever the program is; from then on only `check` does,
    so that no record of the log is cut in two.
    """

    def __init__(self) -> None:
        self._begun = False
        self._name = ""
        self._before: dict[int, Any] = {}

    def begin(self) -> None:
        """The first tick has come."""
        self._begun = True

    def check(self) -> None:
        """Raise Stopped if a signal has come."""
        if self._name:
            raise Stopped(self._name)

    def __enter__(self) -> "SignalWatch":
        if threading.current_thread() is threading.main_thread():
            for name in EXIT_CODES:
                number = signal.Signals[name]
                self._before[number] = signal.signal(number, self._take)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _take(self, number: int, _: Any) -> None:
        self._name = self._name or signal.Signals(number).name
        if not self._begun:
            raise Stopped(self._name)
