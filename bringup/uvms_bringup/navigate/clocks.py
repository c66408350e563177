"""Whether the stamps of a log are those of one clock that runs one way."""

from collections.abc import Mapping, Sequence

import numpy as np

from uvms_bringup.errors import BringupError
from uvms_core.signals import to_nanoseconds, to_seconds

BACK = to_nanoseconds(1.0)
"""By so much no transport and no driver changes the order of a topic's messages, ns."""
AROUND = 5
"""Messages on either side that tell a clock which was set back from one stamp that is wrong."""


class ClockError(BringupError):
    """The stamps of a log are not of one clock."""


def check_one_clock(delays: Mapping[str, int], most: int) -> None:
    """Refuse topics whose delays from stamp to recording (ns) differ by more than `most`.

    Raises:
        ClockError: those of a whole topic are on another clock than those of the first.
    """
    first = next(iter(delays), "")
    for topic, delay in delays.items():
        if abs(delay - delays[first]) > most:
            raise ClockError(
                f"the stamps of {topic} are {to_seconds(delays[first] - delay):.0f} s off those"
                f" of {first}; --stamps log takes the time of recording for all"
            )


def check_one_way(topic: str, stamps: Sequence[int]) -> None:
    """Refuse a clock that was set back; one stamp that is wrong is another matter.

    Args:
        topic: full name.
        stamps: ns, in the order of recording.

    Raises:
        ClockError: says when and by how much.
    """
    values = np.array(stamps, dtype=np.int64)
    for k in np.flatnonzero(np.diff(values) < -BACK) + 1:
        before, after = np.median(values[max(k - AROUND, 0) : k]), np.median(values[k : k + AROUND])
        if after < before - BACK:
            raise ClockError(
                f"the stamps of {topic} go back from {to_seconds(int(values[k - 1])):.3f} s to"
                f" {to_seconds(int(values[k])):.3f} s: their clock was set back, or the log holds"
                " several runs. Cut it there, or take the time of recording by --stamps log"
            )
