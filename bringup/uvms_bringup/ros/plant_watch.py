"""Whether the plant of a run is still there when its clock stands still.

A clock may stand for good reasons: somebody paused the plant, or it waits for a node in lockstep.
A plant that does not answer is halted or hangs. One that has published more than arrived is cut
off: the middleware drops a reader that was halted for long.
"""

import json
import time

from rclpy.node import Node
from std_srvs.srv import Trigger

from uvms_bringup.errors import RunError
from uvms_bringup.ros.recorder import Recorder
from uvms_core import topics
from uvms_core.ros.request import Request

STILL_S = 10.0
"""Wall time without a tick after which the plant is asked."""
ANSWER_S = 15.0
"""Wall time that it has to answer."""


class PlantWatch:
    """Asks a plant that is silent what it has published.

    Args:
        node: that asks.
        recorder: of the run.
    """

    def __init__(self, node: Node, recorder: Recorder) -> None:
        self._client = node.create_client(Trigger, f"{topics.PLANT}/sent")
        self._received = recorder.received
        self._count = 0
        self._since = time.monotonic()
        self._request: Request | None = None

    def check(self) -> None:
        """Called often.

        Raises:
            RunError: the plant does not answer, or what it publishes does not arrive.
        """
        now, count = time.monotonic(), self._received[topics.CLOCK.name]
        if count != self._count:
            self._count, self._since, self._request = count, now, None
        elif self._request is not None:
            self._await_answer(now)
        elif now - self._since > STILL_S and self._client.service_is_ready():
            self._since = now
            self._request = Request(
                lambda: self._client.call_async(Trigger.Request()), self._client.service_is_ready
            )

    def _await_answer(self, now: float) -> None:
        answer = self._request.answer() if self._request is not None else None
        if answer is not None:
            published = json.loads(answer.message)[topics.CLOCK.name]
            if published > self._count:
                raise RunError(
                    f"cut off from the plant: it has published {published} ticks,"
                    f" {self._count} arrived, and none for {STILL_S:g} s"
                )
            self._since, self._request = now, None
        elif now - self._since > ANSWER_S:
            raise RunError(
                f"the plant gave no tick for {STILL_S + ANSWER_S:g} s and does not answer:"
                " it is halted, hangs or is cut off"
            )
