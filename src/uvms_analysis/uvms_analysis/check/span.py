"""The span of a run against what was asked for."""

from collections.abc import Iterator

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.expected import Rhythms
from uvms_analysis.check.finding import SPAN, Finding
from uvms_core.signals import NANOSECONDS

TOLERANCE_TICKS = 1.01
"""Control periods by which a span may differ from what was asked, which need not be whole ticks."""


def check_span(contents: Contents, rhythms: Rhythms | None) -> Iterator[Finding]:
    """A run that began late, ended early without a reason, or went on for too long."""
    if contents.end is None or contents.span is None:
        return
    allowed = TOLERANCE_TICKS * (rhythms.period / NANOSECONDS if rhythms is not None else 0.0)
    first, last = (stamp / NANOSECONDS for stamp in contents.span)
    asked = contents.end.asked_s
    if rhythms is not None and first > allowed:
        yield Finding(SPAN, f"it begins at {first:.3f} s, not at 0")
    if last > asked + allowed:
        yield Finding(SPAN, f"it ends at {last:.3f} s, and {asked:g} s were asked for")
    elif last < asked - allowed and not contents.end.stopped_by:
        yield Finding(SPAN, f"it ends at {last:.3f} s of {asked:g} s, and nothing says why")
