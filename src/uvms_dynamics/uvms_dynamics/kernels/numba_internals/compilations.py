"""What numba compiles and when, by its own events."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import event


class _Begun(event.Listener):
    """Passes on the function of each compilation that begins."""

    def __init__(self, report: Callable[[str, str], None]) -> None:
        self._report = report

    def on_start(self, begun: Any) -> None:
        function = begun.data["dispatcher"].py_func
        self._report(function.__module__, function.__qualname__)

    def on_end(self, _ended: Any) -> None:
        pass


@contextmanager
def reported(report: Callable[[str, str], None]) -> Iterator[None]:
    """Call `report` with module and name of each function as its compilation begins.

    What is loaded from the cache is not reported.
    """
    listener = _Begun(report)
    event.register("numba:compile", listener)
    try:
        yield
    finally:
        event.unregister("numba:compile", listener)
