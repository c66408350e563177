"""The inputs of a node, each with its rule of what belongs to a tick.

A sample that came but cannot be used is excused: the tick does not wait for it, and has the last
good value instead, as long as that is not too old.
"""

from abc import ABC, abstractmethod
from bisect import insort
from collections import deque
from dataclasses import is_dataclass, replace
from operator import itemgetter
from typing import Any

from uvms_core.checks import MAX_AGE_S, trust
from uvms_core.signals import to_nanoseconds

DEPTH = 256
"""Samples an input keeps while it waits: 2.5 s of a 100 Hz sensor."""
KEEP = to_nanoseconds(MAX_AGE_S)
"""How long the last good value stands in for those that cannot be used, ns: as long as control
works with any old state. It is also the longest gap that a part goes on after as if nothing had
been; after a longer one it restarts: its derivatives, integrals and filters would take the gap
for one long step."""
_STAMP = itemgetter(0)


class Input(ABC):
    """One stamped input; the subclasses define when it is complete for a tick."""

    is_companion = False
    """Whether its writer may leave it out."""

    def __init__(self) -> None:
        self._items: deque[tuple[int, Any]] = deque(maxlen=DEPTH)
        self._excused: list[int] = []
        self._has_come = False

    def reset(self) -> None:
        """Forget everything: time starts over."""
        self._items.clear()
        self._excused.clear()
        self._has_come = False

    def push(self, stamp: int, value: Any) -> bool:
        """Store a value; one that is out of order is put in its place. False for a repeated one."""
        self._has_come = True
        items = self._items
        if not items or stamp > items[-1][0]:
            items.append((stamp, value))
            return True
        if any(when == stamp for when, _ in items):
            return False
        ordered = list(items)
        insort(ordered, (stamp, value), key=_STAMP)
        items.clear()
        items.extend(ordered)
        return True

    def excuse(self, stamp: int) -> None:
        """The value of this stamp came but cannot be used; nobody needs to wait for it."""
        self._excused = [*self._excused[-DEPTH:], stamp]

    def missing(self, stamp: int) -> bool:
        """Whether the tick lacks a value of this input, since it was excused and the last is old.

        To be asked before `take`.
        """
        return False

    def newest(self, stamp: int) -> Any:
        """The newest value at or before the stamp, or None."""
        if self._items and self._items[-1][0] <= stamp:  # the usual case, which is quick
            return self._items[-1][1]
        return next((value for when, value in reversed(self._items) if when <= stamp), None)

    @abstractmethod
    def complete(self, stamp: int) -> bool:
        """Whether everything due at the stamp has arrived."""

    def known(self, stamp: int) -> bool:
        """Whether there is a value to use, even an old one."""
        return self.newest(stamp) is not None

    def take(self, stamp: int) -> Any:
        """The value for the tick; older ones are dropped."""
        items = self._items
        if items and items[-1][0] <= stamp:  # the usual case, which is quick
            while len(items) > 1:
                items.popleft()
            return items[0][1]
        value = self.newest(stamp)
        while len(items) > 1 and items[1][0] <= stamp:
            items.popleft()
        return value


class Same(Input):
    """Arrives once per tick, with the stamp of the tick."""

    def complete(self, stamp: int) -> bool:
        """Whether the value of exactly this stamp has arrived, or is excused."""
        items = self._items
        if items and items[-1][0] == stamp:  # the usual case, which is quick
            return True
        return any(when == stamp for when, _ in items) or stamp in self._excused

    def missing(self, stamp: int) -> bool:
        """Whether the value is excused, and the one before it is too old to stand in."""
        if stamp not in self._excused:
            return False
        return not any(stamp - KEEP <= when <= stamp for when, _ in self._items)

    def take(self, stamp: int) -> Any:
        """The value for the tick; where it is excused, the last good one as of this stamp."""
        value = super().take(stamp)
        if self._excused:
            exact = any(when == stamp for when, _ in self._items)
            if stamp in self._excused and not exact:
                value = held(value, stamp)
            self._excused = [each for each in self._excused if each > stamp]
        return value


class Delayed(Same):
    """As `Same`, of what may come late: then the newest that has come, with its own stamp.

    In lockstep only the plant knows what will not come in time, and says so (`skip`); without a
    word from it the value of the stamp is waited for.
    """

    def __init__(self) -> None:
        super().__init__()
        self._begin()

    def _begin(self) -> None:
        self._newest = -1
        self._gaps: dict[int, int] = {}

    def reset(self) -> None:
        """Forget everything: time starts over."""
        super().reset()
        self._begin()

    def push(self, stamp: int, value: Any) -> bool:
        """Store a value, as any input does."""
        self._newest = max(self._newest, stamp)
        return super().push(stamp, value)

    def excuse(self, stamp: int) -> None:
        """The value of this stamp came but cannot be used."""
        self._newest = max(self._newest, stamp)
        super().excuse(stamp)

    def skip(self, stamp: int, newest: int) -> None:
        """At the tick of this stamp its value does not come; `newest` is what has come by it."""
        self._gaps[stamp] = newest

    def complete(self, stamp: int) -> bool:
        """Whether the value of this stamp has arrived, or all that comes by it."""
        if self._gaps and stamp in self._gaps:
            return self._gaps[stamp] <= self._newest
        return super().complete(stamp)

    def missing(self, stamp: int) -> bool:
        """Whether there is no value at all, or an excused one has none to stand in."""
        if stamp in self._gaps:
            return self.newest(self._gaps[stamp]) is None
        return super().missing(stamp)

    def take(self, stamp: int) -> Any:
        """The value for the tick: nothing that came after it, though its stamp may be before."""
        if not self._gaps:  # the usual case, which is quick
            return super().take(stamp)
        newest = self._gaps.get(stamp)
        value = super().take(stamp) if newest is None else super().take(min(newest, stamp))
        self._gaps = {at: last for at, last in self._gaps.items() if at > stamp}
        return value


class Previous(Input):
    """Feedback from the previous tick, `period` nanoseconds ago."""

    def __init__(self, period: int) -> None:
        super().__init__()
        self._period = period

    def complete(self, stamp: int) -> bool:
        """Whether the value of the previous tick has arrived, or is excused."""
        due = stamp - self._period
        return any(when == due for when, _ in self._items) or due in self._excused

    def known(self, stamp: int) -> bool:
        """Always: at the first tick there is none."""
        return True

    def take(self, stamp: int) -> Any:
        """The newest value before the tick, None at the first."""
        return super().take(stamp - 1)


class Companion(Same):
    """As `Same`, of what nobody need publish: waited for once a first value has come.

    It tells more about another input, so that a writer of somebody else's may leave it out. Before
    its first value there is nothing to tell, so that it does not matter when that comes.
    """

    is_companion = True

    def complete(self, stamp: int) -> bool:
        """Whether it has arrived, is excused, or nobody publishes it."""
        return not self._has_come or super().complete(stamp)

    def known(self, stamp: int) -> bool:
        """Always: it may be left out."""
        return True


class CompanionBefore(Previous):
    """As `Previous`, of what nobody need publish; see `Companion`."""

    is_companion = True

    def complete(self, stamp: int) -> bool:
        """Whether it has arrived, is excused, or nobody publishes it."""
        return not self._has_come or super().complete(stamp)


class Periodic(Input):
    """A sensor at its own rate, due at multiples of `period`: all samples since the last tick."""

    def __init__(self, period: int) -> None:
        super().__init__()
        self._period = period
        self._begin()

    def _begin(self) -> None:
        self._taken = self._newest = self._first = -1
        self._gaps: dict[int, int] = {}

    def reset(self) -> None:
        """Forget everything: time starts over."""
        super().reset()
        self._begin()

    def push(self, stamp: int, value: Any) -> bool:
        """Store a value, as any input does."""
        self._newest = max(self._newest, stamp)
        return super().push(stamp, value)

    def begin(self, stamp: int) -> None:
        """The node starts to listen at this stamp: what was due before is not waited for."""
        self._taken = max(self._taken, stamp - 1)
        self._first = stamp

    def skip(self, stamp: int, newest: int) -> None:
        """At the tick of this stamp what is due does not come; `newest` is what has come by it."""
        self._gaps[stamp] = newest

    def excuse(self, stamp: int) -> None:
        """The sample of this stamp came but cannot be used: the tick does without."""
        self._newest = max(self._newest, stamp)
        self._taken = max(self._taken, stamp)

    def complete(self, stamp: int) -> bool:
        """Whether the sample that is due at or before the stamp has arrived, or is excused."""
        if self._gaps and stamp in self._gaps:
            newest = self._gaps[stamp]
            return newest < self._first or newest <= self._newest
        due = stamp - stamp % self._period
        return due <= self._taken or (bool(self._items) and self._items[-1][0] >= due)

    def known(self, stamp: int) -> bool:
        """Always: a silent sensor does not stop the node."""
        return True

    def take(self, stamp: int) -> tuple[Any, ...]:
        """All samples since the last tick, in order."""
        samples = []
        while self._items and self._items[0][0] <= stamp:
            when, value = self._items.popleft()
            self._taken = max(self._taken, when)
            samples.append(value)
        if self._gaps:
            if stamp in self._gaps:
                self._taken = max(self._taken, stamp)
            self._gaps = {at: newest for at, newest in self._gaps.items() if at > stamp}
        return tuple(samples)


class Covering(Input):
    """A value that holds for a time (`value.end`): the newest with stamp <= tick < end.

    A value that cannot be used excuses the ticks that it would have covered, as many as the one
    before it did: from then on the next one is due and waited for. That does not depend on the
    order in which the topics arrive.
    """

    def __init__(self) -> None:
        super().__init__()
        self._span = KEEP  # where there was no good value before
        self._excuses: list[tuple[int, int]] = []

    def reset(self) -> None:
        """Forget everything: time starts over."""
        super().reset()
        self._span = KEEP
        self._excuses.clear()

    def push(self, stamp: int, value: Any) -> bool:
        """Store a value, as any input does."""
        self._span = value.end - stamp
        return super().push(stamp, value)

    def excuse(self, stamp: int) -> None:
        """The value of this stamp came but cannot be used."""
        super().excuse(stamp)
        self._excuses = [*self._excuses[-DEPTH:], (stamp, stamp + self._span)]

    def complete(self, stamp: int) -> bool:
        """Whether a value covers the stamp, or one that would is excused."""
        if any(when <= stamp < value.end for when, value in self._items):
            return True
        return any(when <= stamp < end for when, end in self._excuses)

    def missing(self, stamp: int) -> bool:
        """Whether the last good value ended too long ago to stand in."""
        return bool(self._excused) and not any(
            when <= stamp < value.end + KEEP for when, value in self._items
        )

    def take(self, stamp: int) -> Any:
        """The value for the tick; older ones are dropped."""
        value = super().take(stamp)
        if self._excused and value is not None and stamp < value.end:
            self._excused = [each for each in self._excused if each > stamp]
        if self._excuses:
            self._excuses = [(when, end) for when, end in self._excuses if end > stamp]
        return value


def held(value: Any, stamp: int) -> Any:
    """A checked signal as of a later stamp, as if it had not changed since."""
    if is_dataclass(value) and not isinstance(value, type) and hasattr(value, "stamp"):
        return trust(replace(value, stamp=stamp))
    return value
