"""A service call that is repeated while no answer arrives.

A service may drop its answer where it has not yet found the one who asked (rmw_fastrtps then says
"client will not receive response"); the client never learns of it.
"""

import time
from collections.abc import Callable
from typing import Any

from rclpy.task import Future

ASK_AGAIN_S = 5.0
"""Wall time without an answer after which a request is repeated."""


class Request:
    """Sends without waiting. The request must be idempotent.

    Args:
        ask: sends the question; the future holds the answer.
        ready: whether somebody is there to be asked.
        again_s: wall time after which it is asked again, s.
    """

    def __init__(
        self, ask: Callable[[], Future], ready: Callable[[], bool], again_s: float = ASK_AGAIN_S
    ) -> None:
        self._ask, self._ready, self._again_s = ask, ready, again_s
        self._asked: list[Future] = []
        self._due = 0.0

    @property
    def times_asked(self) -> int:
        """How often the request was sent."""
        return len(self._asked)

    def answer(self) -> Any:
        """The first answer, even a late one; None before it, and repeats the request when due."""
        for future in self._asked:
            if future.done():
                return future.result()
        now = time.monotonic()
        if now >= self._due and self._ready():
            self._asked.append(self._ask())
            self._due = now + self._again_s
        return None
