"""Paired timing: ours and its references take turns in one process, round by round.

Machines are noisy: clock rates drift within seconds, and other programs interrupt for milliseconds.
Within a round of a millisecond or two both sides mostly run under the same conditions, so that the
ratio of a round is meaningful where two separate times are not. The result is the median of the
rounds' ratios.
"""

import gc
import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

ROUNDS, MOST_ROUNDS = 31, 125
"""Rounds of calls that take long by themselves, and of short ones."""

ROUND_S = 0.001
"""Approximate working time of each side in a round, or one call where that takes longer."""

Work = Callable[[], object]


@dataclass(frozen=True)
class Timing:
    """Least time of a call of ours in s, and its ratio to each reference's by name.

    A ratio below 1 means that we are faster; that of rates, such as steps a second, is its inverse.
    """

    seconds: float
    ratio: dict[str, float]


def paired(ours: Work, references: Mapping[str, Work], rounds: int | None = None) -> Timing:
    """Time `ours` against each of `references`; `rounds` defaults to what their length allows.

    A side's calls per round are chosen so that all work for about ROUND_S and are
    interrupted equally often; every other round runs the sides in reverse, so that none is always
    first.
    """
    sides = {"": ours, **references}
    once = {name: _seconds_of_one(work) for name, work in sides.items()}
    long = max(ROUND_S, *once.values())
    counts = {name: max(1, round(long / seconds)) for name, seconds in once.items()}
    rounds = rounds or max(ROUNDS, int(MOST_ROUNDS * ROUND_S / long))
    times: dict[str, list[float]] = {name: [] for name in sides}
    order = list(sides)
    gc.collect()
    gc.disable()
    try:
        for _ in range(rounds):
            for name in order:
                times[name].append(seconds_per_call(sides[name], counts[name]))
            order.reverse()
    finally:
        gc.enable()
    ratio = {
        name: statistics.median(a / b for a, b in zip(times[""], times[name], strict=True))
        for name in references
    }
    return Timing(min(times[""]), ratio)


def seconds_per_call(work: Work, count: int) -> float:
    """Mean time of `count` calls in a row."""
    began = time.perf_counter()
    for _ in range(count):
        work()
    return (time.perf_counter() - began) / count


def processor_seconds_per_call(work: Work, count: int) -> float:
    """The same in processor time of this process, which other programs do not lengthen as they
    do wall time.
    """
    began = time.process_time()
    for _ in range(count):
        work()
    return (time.process_time() - began) / count


def _seconds_of_one(work: Work) -> float:
    work()  # compiles, and fills caches
    return min(seconds_per_call(work, 1) for _ in range(3))
