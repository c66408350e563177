"""The planner's ticks while it waits for the next goal of a run in lockstep."""

from collections import deque
from collections.abc import Callable

from uvms_core.tick_gate import Tick


class Turns:
    """Hands ticks on, or keeps them between the end of a goal and the answer to the next one.

    Without a reference the other nodes soon stand as well, and simulated time with them: the next
    goal begins where the one before it has ended, however long it is on its way and planned.

    Args:
        step: takes a tick.
    """

    def __init__(self, step: Callable[[Tick], None]) -> None:
        self._step = step
        self._waits = self._is_due = False
        self._kept: deque[Tick] = deque()

    @property
    def is_waiting(self) -> bool:
        """Whether ticks are kept."""
        return self._waits and self._is_due

    def take(self, tick: Tick) -> None:
        """Step, at once or when a goal has been answered."""
        self._kept.append(tick)
        self._hand_on()

    def wait(self, waits: bool) -> None:
        """Whether to wait for a goal whenever one is due."""
        self._waits = waits
        self._hand_on()

    def goal_is_due(self) -> None:
        """A goal has succeeded, or none could begin before now."""
        self._is_due = True

    def goal_is_answered(self) -> None:
        """A goal has begun, or was rejected."""
        self._is_due = False
        self._hand_on()

    def forget(self) -> None:
        """What was kept is of another time."""
        self._kept.clear()

    def _hand_on(self) -> None:
        while self._kept and not self.is_waiting:
            self._step(self._kept.popleft())
