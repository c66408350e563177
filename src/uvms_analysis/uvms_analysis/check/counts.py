"""How many messages each topic has, against what was sent and what the rates promise."""

from collections.abc import Iterator

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.expected import Rhythms
from uvms_analysis.check.finding import COUNT, Finding
from uvms_core import topics

UNANSWERED_SHARE = 0.05
"""In real time a node may miss ticks. Up to this share the loop is still the one that was meant:
a controller at 20 Hz that loses every twentieth sample has the phase lag of one at 19 Hz."""

LAST_TICK = 1
"""Messages that may be missing where a run was stopped in the middle of a tick, or in real time."""


NEEDED = (
    topics.ODOMETRY,
    topics.JOINT_STATES,
    topics.REFERENCE,
    topics.ALLOCATION,
    topics.THRUSTER_COMMAND,
    topics.JOINT_COMMAND,
)
"""What the outcome of a run is judged by, besides what only a simulated plant can say."""
OF_THE_PLANT = (topics.TRUE_ODOMETRY, topics.TRUE_JOINT_STATES, topics.APPLIED_THRUST)


def check_counts(contents: Contents, rhythms: Rhythms | None) -> Iterator[Finding]:
    """Topics with messages too few or too many."""
    end = contents.end
    sent = dict(end.sent) if end is not None else {}
    for name, count in sent.items():
        yield from _against_sent(contents, name, count)
    if end is not None:
        for name, count in end.lost.items():
            if count > 0 and name not in sent:
                yield Finding(COUNT, f"{count} messages were lost on their way to the log", name)
    if rhythms is None or contents.span is None:
        return
    for name, expected in expected_counts(contents, rhythms).items():
        yield from _against_rate(contents, name, expected, sent)


def expected_counts(contents: Contents, rhythms: Rhythms | None) -> dict[str, int]:
    """Messages by full topic name that the rates promise over the span that was reached."""
    if rhythms is None or contents.span is None:
        return {}
    span = contents.span[1]
    return {name: rhythm.count(span) for name, rhythm in rhythms.topics.items()}


def _received(contents: Contents, name: str) -> int:
    return len(contents.topics[name].stamps) if name in contents.topics else 0


def _against_sent(contents: Contents, name: str, sent: int) -> Iterator[Finding]:
    received = _received(contents, name)
    if received < sent:
        text = f"{sent - received} of {sent} messages that were sent are not in the log"
        yield Finding(COUNT, text, name)
    elif received > sent:
        text = f"{received} messages are in the log, but its nodes sent {sent}: others took part"
        yield Finding(COUNT, text, name)


def _against_rate(
    contents: Contents, name: str, expected: int, sent: dict[str, int]
) -> Iterator[Finding]:
    received = _received(contents, name)
    missing = expected - received
    if missing == 0:
        return
    if missing < 0:
        yield Finding(COUNT, f"{received} messages, {-missing} more than expected", name)
        return
    stopped = contents.end is None or bool(contents.end.stopped_by)
    text = f"{missing} of {expected} messages are missing"
    if received == 0 and sent and name not in sent:
        text = "no message; no node of the run published it"
        yield Finding(COUNT, text, name, serious=_is_needed(contents, name, sent))
    elif missing <= LAST_TICK and (stopped or not contents.is_lockstep):
        yield Finding(COUNT, f"{text}: of the last tick", name, serious=False)
    elif sent.get(name) == received and not contents.is_lockstep:
        serious = missing > UNANSWERED_SHARE * expected
        text = f"{missing} of {expected} ticks were not answered (bound {UNANSWERED_SHARE:.0%})"
        yield Finding(COUNT, text, name, serious=serious)
    else:
        yield Finding(COUNT, text, name)


def _is_needed(contents: Contents, name: str, sent: dict[str, int]) -> bool:
    """Whether nothing can be said about a run without this topic.

    A plant that is not ours, and gives no counts, may have no truth to publish: the limits are
    judged by the estimates then.
    """
    foreign_plant = topics.CLOCK.name not in sent
    needed = NEEDED if foreign_plant else (*NEEDED, *OF_THE_PLANT)
    return name in map(contents.log.full_name, needed)
