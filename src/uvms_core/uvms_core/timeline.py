"""The time of a node: the newest stamp that its inputs agree on.

A node has no clock of its own that it could trust: /clock is one more topic, and a bag or a driver
may not publish it. Its inputs together are the better clock. A message whose stamp is far ahead of
them, or far back on its own topic, is held as a suspect. Another topic, or the next messages of the
same topic, then either confirm it (time has jumped) or contradict it (it was wrong, and is left
out). Either way it never blocks those behind it.

Free of ROS; wall time is an argument.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

from uvms_core.signals import to_nanoseconds, to_seconds

TOLERANCE_S = 0.25
"""Stamps of a running system lie this close together: five control periods at 20 Hz. Wide enough
for a node that is late, narrow enough that a wrong stamp within it costs a quarter of a second."""
PERIODS = 3
"""The same in control periods, for a slower loop."""
CONFIRMED = 3
"""Messages of one topic, each later than the one before, that make a jump of time believed."""
SILENCE_S = 0.5
"""Wall time without any message, after which time is believed to have gone back: a lockstep plant
that is restarted sends one message and waits for its answer."""
LEAD_S = 5.0
"""How far a plan may lie ahead of the node's time: its stamp is that of its first point."""
_MOST_SUSPECTS = 64
AHEAD, BACK, DUPLICATES, NEGATIVE = "ahead", "back", "duplicates", "negative"


class Item(NamedTuple):
    """A message on its way into a node."""

    name: str  # of its topic
    stamp: int  # ns
    content: Any


@dataclass(frozen=True)
class Jump:
    """Time that is believed to have jumped, ns."""

    before: int
    after: int

    @property
    def is_back(self) -> bool:
        """Whether time went back."""
        return self.after < self.before

    def __str__(self) -> str:
        way = "back" if self.is_back else "ahead"
        return f"time went {way} from {to_seconds(self.before):g} s to {to_seconds(self.after):g} s"


class Judged(NamedTuple):
    """What may go on, in the order of stamps; after the jump, where there is one."""

    items: tuple[Item, ...] = ()
    jump: Jump | None = None


NOTHING = Judged()


def tolerance(period: int) -> int:
    """How far apart the stamps of a running system may be, ns; `period` of the control loop, ns."""
    return max(to_nanoseconds(TOLERANCE_S), PERIODS * period)


class Timeline:
    """Judges the stamps of a node's inputs.

    Args:
        period: of the control loop, ns.
        plans: topics whose stamps lie ahead, as a plan's do.
    """

    def __init__(self, period: int, plans: Iterable[str] = ()) -> None:
        self._tolerance = tolerance(period)
        self._plans = frozenset(plans)
        self._lead = max(to_nanoseconds(LEAD_S), PERIODS * period)
        self._newest: dict[str, int] = {}
        self._suspects: list[Item] = []
        self._heard = 0.0
        self.now: int | None = None
        """The newest stamp that is believed, ns."""
        self.counts: Counter[str] = Counter()
        self.refusals: list[str] = []
        """Stamps that were refused since this was last emptied, in words."""

    @property
    def newest(self) -> Mapping[str, int]:
        """Newest stamp of each topic, ns."""
        return self._newest

    def judge(self, item: Item, wall: float) -> Judged:
        """What may go on now that this message has come; `wall` is monotonic time in s."""
        self._heard = wall
        name, stamp, _ = item
        last, plan = self._newest.get(name), name in self._plans
        if self.now is not None and stamp > self.now + (self._lead if plan else self._tolerance):
            return self._suspect(item)
        if last is not None and stamp <= last:
            if stamp < last - (self._lead if plan else self._tolerance):
                return self._suspect(item)
            if stamp == last:
                self.counts[DUPLICATES] += 1
                return NOTHING
        elif stamp < 0:
            self._refuse(item, NEGATIVE, "is negative")
            return NOTHING
        if self._suspects:
            self._contradict(name)
        self._believe(item)
        return Judged((item,))

    def may_be(self, stamp: int, name: str) -> bool:
        """Whether a message of this stamp would be believed at once; for unreadable ones,
        which confirm nothing and are not held.
        """
        last = self._newest.get(name)
        lead = self._lead if name in self._plans else self._tolerance
        if self.now is None or stamp > self.now + lead or stamp < 0:
            return False
        return last is None or stamp > last

    def poll(self, wall: float) -> Judged:
        """Believe a step back that nothing has followed for a while."""
        if not self._suspects or wall - self._heard < SILENCE_S or self.now is None:
            return NOTHING
        last = self._suspects[-1]
        if last.stamp >= self.now or last.stamp < 0:
            return NOTHING
        return self._jump(self._agreeing(last))

    def _believe(self, item: Item) -> None:
        name, stamp, _ = item
        if stamp > self._newest.get(name, -1):
            self._newest[name] = stamp
        if name not in self._plans and (self.now is None or stamp > self.now):
            self.now = stamp

    def _suspect(self, item: Item) -> Judged:
        self._suspects.append(item)
        if len(self._suspects) > _MOST_SUSPECTS:
            self._drop([self._suspects[0]])
        agreeing = self._agreeing(item)
        own = [each.stamp for each in agreeing if each.name == item.name]
        rising = sum(a < b for a, b in pairwise(own)) + 1
        others = {each.name for each in agreeing} - self._plans
        if item.stamp >= 0 and (len(others) > 1 or (rising >= CONFIRMED and others)):
            return self._jump(agreeing)
        return NOTHING

    def _agreeing(self, item: Item) -> list[Item]:
        return [s for s in self._suspects if abs(s.stamp - item.stamp) <= self._tolerance]

    def _jump(self, items: list[Item]) -> Judged:
        items = sorted(items, key=lambda item: item.stamp)
        jump = Jump(self.now or 0, items[-1].stamp)
        taken = {id(item) for item in items}
        self._suspects = [each for each in self._suspects if id(each) not in taken]
        self._drop(list(self._suspects))
        if jump.is_back:
            self._newest.clear()
        self.now = None
        for item in items:
            self._believe(item)
        return Judged(tuple(items), jump)

    def _contradict(self, name: str) -> None:
        self._drop([each for each in self._suspects if each.name == name])

    def _drop(self, items: list[Item]) -> None:
        now = self.now or 0
        for item in items:
            self._suspects = [each for each in self._suspects if each is not item]
            far = to_seconds(abs(item.stamp - now))
            if item.stamp > now:
                self._refuse(item, AHEAD, f"is {far:g} s ahead of the other inputs")
            else:
                self._refuse(item, BACK, f"is {far:g} s behind the other inputs")

    def _refuse(self, item: Item, cause: str, why: str) -> None:
        self.counts[cause] += 1
        self.refusals.append(f"{item.name}: its stamp, {to_seconds(item.stamp):g} s, {why}")
