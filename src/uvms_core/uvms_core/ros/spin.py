"""Spin nodes on one EventsExecutor until a signal or their own end, and shut down cleanly.

The EventsExecutor is several times faster than the default one. It must be spun with a finite
time-out (without one it neither sleeps nor fires timers), and signals are taken by a thread of
their own, because a handler that runs inside rcl's wait crashes now and then.
"""

import faulthandler
import os
import signal
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

SIGNALS = (signal.SIGINT, signal.SIGTERM)
LEAVE_S = 10.0
"""Longest wall time for leaving ROS, which takes some hundredths of a second, s."""
IDLE = 0.2
"""Longest sleep between two checks of the nodes' deadlines, s."""


def start(args: Sequence[str] | None = None) -> None:
    """Initialise rclpy with SIGINT and SIGTERM blocked, to be taken by `Spinner`."""
    signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    rclpy.init(
        args=None if args is None else list(args), signal_handler_options=SignalHandlerOptions.NO
    )


class Spinner:
    """Runs nodes in one executor.

    A node may have a `deadline() -> float | None` (monotonic seconds at which it wants to be woken)
    and an `on_wake()` that is then called in the executor's own thread.

    While events keep coming the executor does not look at the clock; a callback that comes often
    calls `yield_turn`, so that deadlines and `until` are checked all the same.

    `signal` is the name of the signal that ended it, empty before.
    """

    def __init__(self, nodes: Sequence[Node]) -> None:
        self._nodes = list(nodes)
        self._executor = EventsExecutor()
        for node in nodes:
            self._executor.add_node(node)
        self.signal = ""
        self.done: Future = Future()
        self._turn: Future = Future()
        self._turn_ends = 0.0
        self._wakers: list[Any] = []
        self._note_wakers(nodes)
        # Threads created before `start` (by a BLAS library, say) do not block the signals; a signal
        # delivered to one of them runs this handler, between two sleeps of the main thread.
        for number in SIGNALS:
            signal.signal(number, lambda number, _: self._finish(number))
        threading.Thread(target=self._take_signal, daemon=True).start()

    def add(self, nodes: Sequence[Node]) -> None:
        """Run further nodes."""
        for node in nodes:
            self._nodes.append(node)
            self._executor.add_node(node)
        self._note_wakers(nodes)

    def _note_wakers(self, nodes: Sequence[Node]) -> None:
        self._wakers += [node for node in nodes if hasattr(node, "on_wake")]

    def stop(self) -> None:
        """End `spin` from any thread."""
        self._finish()
        self._executor.wake()

    def yield_turn(self) -> None:
        """From a callback: let `spin` check deadlines and `until`, if it has not for a while."""
        if time.monotonic() >= self._turn_ends and not self._turn.done():
            self._turn.set_result(None)

    def _finish(self, number: int | None = None) -> None:
        if number is not None:
            self.signal = self.signal or signal.Signals(number).name
        for future in (self.done, self._turn):
            if not future.done():
                future.set_result(None)

    def spin(self, until: Callable[[], bool] = lambda: False) -> None:
        """Serve callbacks and deadlines until `stop`, a signal, or `until()` is true."""
        while rclpy.ok() and not self.done.done() and not until():
            self.spin_once(IDLE)

    def spin_once(self, timeout: float) -> None:
        """Serve events for at most the time-out, s."""
        wait = min(timeout, self._sleep())
        self._turn, self._turn_ends = Future(), time.monotonic() + wait
        if not self.done.done():
            self._executor.spin_until_future_complete(self._turn, timeout_sec=wait)
        self._wake()

    def serve(self, timeout: float) -> None:
        """Serve events for this long, s, even after a `stop`."""
        self._executor.spin_until_future_complete(Future(), timeout_sec=timeout)

    def spin_for(self, future: Future, timeout: float) -> bool:
        """Serve callbacks until the future is done; False after the time-out, s, or a `stop`."""
        end = time.monotonic() + timeout
        while not future.done() and not self.done.done():
            left = end - time.monotonic()
            self._executor.spin_until_future_complete(future, timeout_sec=max(min(left, IDLE), 0.0))
            if left <= 0.0:
                break
        return future.done()

    def shutdown(self) -> None:
        """Destroy the nodes and leave ROS; a process that cannot leave is ended after LEAVE_S.

        Fast DDS 2.14 can deadlock here when others leave the graph at the same moment: it waits
        for a discovery callback that waits for a lock of its own. Python's global lock is held
        meanwhile, so that no thread or signal handler of Python could end it.
        """
        with open(os.devnull, "w") as nowhere:
            faulthandler.dump_traceback_later(LEAVE_S, exit=True, file=nowhere)
            try:
                self._executor.shutdown()
                for node in self._nodes:
                    node.destroy_node()
                rclpy.try_shutdown()
            finally:
                faulthandler.cancel_dump_traceback_later()

    def _take_signal(self) -> None:
        number = signal.sigwait(SIGNALS)
        self._finish(number)
        self._executor.wake()

    def _sleep(self) -> float:
        deadlines = [node.deadline() for node in self._wakers]
        times = [IDLE, *(d - time.monotonic() for d in deadlines if d is not None)]
        return max(min(times), 1e-4)

    def _wake(self) -> None:
        now = time.monotonic()
        for node in self._wakers:
            deadline = node.deadline()
            if deadline is not None and now >= deadline:
                node.on_wake()
