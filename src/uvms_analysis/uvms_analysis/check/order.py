"""The stamps of each topic: they rise, none comes twice, and there are no holes between them."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.check.contents import Contents, Topics
from uvms_analysis.check.expected import Rhythms
from uvms_analysis.check.finding import ORDER, Finding
from uvms_core import topics
from uvms_core.signals import NANOSECONDS

MANY_PUBLISHERS = ("/diagnostics", "/rosout", "/parameter_events")
"""Topics that all nodes publish: their stamps need not rise."""

HOLE = 1.5
"""A distance of more periods than this is a hole: stamps stand on a grid of whole periods."""

FOREIGN_HOLE = 10.0
"""The same for a log whose rates are not known, over the median distance: worth a note."""


def check_order(contents: Contents, rhythms: Rhythms | None) -> Iterator[Finding]:
    """Time that goes back, doubled messages and holes, topic by topic."""
    for name, found in contents.topics.items():
        many = name in MANY_PUBLISHERS
        if len(found.stamps) > 1:
            if many or not contents.is_ours:
                yield from _doubled(name, found, serious=contents.is_ours and not many)
            if not many:
                yield from _rising(name, found, contents.is_ours)
                yield from _holes(contents, rhythms, name, found)
    yield from _nodes(contents)


def _seconds(stamp: int) -> str:
    return f"{stamp / NANOSECONDS:.3f} s"


def _rising(name: str, found: Topics, ours: bool) -> Iterator[Finding]:
    steps = np.diff(found.times)
    back = np.flatnonzero(steps < 0)
    if len(back):
        at = back[0]
        text = (
            f"time goes back {len(back)} times, first from {_seconds(found.times[at])}"
            f" to {_seconds(found.times[at + 1])}"
        )
        yield Finding(ORDER, text, name)
    if ours and (count := int(np.sum(steps == 0))):
        first = _seconds(found.times[np.flatnonzero(steps == 0)[0]])
        yield Finding(ORDER, f"{count} stamps come twice, the first at {first}", name)


def _doubled(name: str, found: Topics, serious: bool) -> Iterator[Finding]:
    """Messages that follow one another with the same stamp and the same bytes."""
    same = (np.diff(found.times) == 0) & (np.diff(np.array(found.checksums, dtype=np.int64)) == 0)
    if count := int(same.sum()):
        yield Finding(ORDER, f"{count} messages are there twice", name, serious=serious)


def _holes(
    contents: Contents, rhythms: Rhythms | None, name: str, found: Topics
) -> Iterator[Finding]:
    times = np.unique(found.times)
    if len(times) < 2:
        return
    steps: NDArray[np.int64] = np.diff(times)
    known = rhythms is not None and name in rhythms.topics
    period = rhythms.topics[name].period if rhythms is not None and known else 0
    usual = period or int(np.median(steps))
    if known and not period:
        return
    holes = np.flatnonzero(steps > (HOLE if known else FOREIGN_HOLE) * usual)
    if len(holes):
        at = holes[np.argmax(steps[holes])]
        text = f"{len(holes)} holes, the longest from {_seconds(times[at])} to"
        text += f" {_seconds(times[at + 1])}"
        # In real time the counts say whether the holes are too many.
        yield Finding(ORDER, text, name, serious=known and contents.is_lockstep)


def _nodes(contents: Contents) -> Iterator[Finding]:
    """Each node's own diagnostics are in order."""
    if not contents.is_ours or contents.of(topics.DIAGNOSTICS) is None:
        return
    if contents.log.full_name(topics.DIAGNOSTICS) in contents.unusable:
        return
    newest: dict[str, int] = {}
    for status in contents.log.signals(topics.DIAGNOSTICS):
        if status.stamp < newest.get(status.name, status.stamp):
            text = f"those of {status.name} go back to {_seconds(status.stamp)}"
            yield Finding(ORDER, text, topics.DIAGNOSTICS.name)
            return
        newest[status.name] = status.stamp
