"""Whether the estimate is wrong where a sensor is rejected.

A sensor that is rejected sample after sample, or whose residuals are together too large to be
noise, lies, or what it is compared with is wrong. The filter tries what that may be: from the last
sample on that was used, the same samples are taken by an estimator that doubts something else. If
it explains them all it goes on in place of the first one.

- The inertial unit, whose biases may step. A sensor that lies jumps and then goes on as before,
  which no bias explains: it stays rejected.
- The start, or what was reckoned while a sensor was away for long: then velocity, or position as
  well. These explain a jump, and are believed of a sensor that has just come (back) only.

Multiple hypotheses: Bar-Shalom, Li and Kirubarajan (2001), sec. 11.6.
"""

from bisect import bisect_right
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter

from uvms_core.signals import to_nanoseconds
from uvms_observer.navigation.estimator import Estimator
from uvms_observer.navigation.time_line import Step, replayed
from uvms_observer.navigation.trust.innovation_gate import FEW, WINDOW_S, quantile

BEFORE = [to_nanoseconds(seconds) for seconds in (0.0, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0)]
"""When something happened: so long before the last sample that was used."""
PATIENCE = to_nanoseconds(0.5)
"""How long a sensor must have been rejected."""
AGAIN = to_nanoseconds(0.25)
"""From one look to the next. After a trial that explained nothing it is twice as long each time."""
LONGEST = to_nanoseconds(4.0)
"""Between two trials: each takes what a second of samples takes."""
WINDOW = to_nanoseconds(WINDOW_S)
"""Over which the residuals of a sensor that is used are looked at."""
ABSENT = to_nanoseconds(20.0)
"""A sensor that has said nothing for so long knows better than what was reckoned meanwhile."""
IMPOSSIBLE = 1.0 - 1e-8
"""Share of right filters whose residuals add up to less within `WINDOW`."""
BIASED = 6.0
"""Standard deviations that the running mean of residuals is off zero: those of a right filter are
white, whatever their size."""
BROKEN = 10.0
"""Times the biases that a fault of an inertial unit usually leaves: of a worse fault."""
NEXT = 4
"""Of the begins, the latest ones, at which such a fault is looked for: it shows at once."""
LIKELY = 0.999
"""Share of right explanations whose residuals are as small as those of the trial must be."""
BETTER = 6.0
"""By which the squared distances of an explanation may add up to more than those of a sensor that
is off: a factor of 20 between their likelihoods."""
MISSED = 0.01
"""Share of samples that a right explanation may reject: a gate rejects good ones, too."""
MEMORY = to_nanoseconds(5.0)
"""How far back a trial may begin."""

_BEGIN = attrgetter("begin")
Doubt = Callable[[Estimator], None]
Trial = tuple[list[Step], Estimator]


@dataclass(frozen=True)
class Suspect:
    """A sensor that does not fit the estimate."""

    name: str
    since: int  # ns, stamp of its first sample that did not
    used: int | None  # ns, stamp of the last one that was used before


def suspects(steps: Sequence[Step], estimator: Estimator, stamp: int) -> list[Suspect]:
    """The sensors that have not fitted for long enough at `stamp`, ns."""
    found = []
    for name, tally in estimator.tallies.items():
        if tally.excluded and tally.since is not None and stamp - tally.since >= PATIENCE:
            found.append(Suspect(name, tally.since, tally.used))
        elif (begin := _does_not_fit(name, steps, estimator, stamp)) is not None:
            found.append(Suspect(name, begin, begin))
    return found


def _does_not_fit(name: str, steps: Sequence[Step], estimator: Estimator, stamp: int) -> int | None:
    """Since when (ns) the samples of a sensor that is used are too far off together."""
    last = estimator.tallies[name]
    index = _last_before(steps, stamp - WINDOW) if last.accepted >= FEW else -1
    if index < 0 or steps[index].begin < 0:
        return None
    first = steps[index].before.tallies[name]
    taken = last.accepted - first.accepted
    if taken < FEW:
        return None
    limit = quantile(taken * estimator.size_of(name), IMPOSSIBLE)
    is_biased = max(abs(last.mean)) > BIASED
    return steps[index].begin if is_biased or last.distance - first.distance > limit else None


def tried(steps: Sequence[Step], suspect: Suspect, now: Estimator) -> Trial | None:
    """Steps that explain what does not fit, and where they lead; None where nothing explains it."""
    names = {suspect.name, *_rejected(now)}
    for begin, doubt in _explanations(steps, suspect):
        found = _tried_from(steps, begin, doubt, names)
        if found is not None and _fits_better(suspect.name, steps[begin].before, found[1], now):
            return found
    return None


def _fits_better(name: str, before: Estimator, after: Estimator, now: Estimator) -> bool:
    """Whether the samples fit at least as well as if their sensor were off since a jump."""
    first, last = before.tallies[name], after.tallies[name]
    expected = (last.accepted - first.accepted) * after.size_of(name)
    misfit = last.distance - first.distance - expected
    return misfit <= now.misfit_of(name) + BETTER


def _explanations(steps: Sequence[Step], suspect: Suspect) -> list[tuple[int, Doubt]]:
    """Indices of steps and what to doubt from there on, the likeliest first."""
    since, used = suspect.since, suspect.used
    if used is None or since - used > ABSENT:
        begin = max(0, _last_before(steps, since))
        return [(begin, Estimator.doubt_velocity), (begin, Estimator.doubt_place)]
    begins = {_last_before(steps, used - before) for before in BEFORE} - {-1}
    latest = sorted(begins, reverse=True)
    broken = partial(Estimator.doubt_imu, times=BROKEN)
    return [
        *((begin, Estimator.doubt_imu) for begin in latest),
        *((begin, broken) for begin in latest[:NEXT]),
    ]


def _last_before(steps: Sequence[Step], time: int) -> int:
    """Index of the last step that begins at `time` (ns) or before; -1 where none does."""
    return bisect_right(steps, time, key=_BEGIN) - 1


def _tried_from(
    steps: Sequence[Step], index: int, doubt: Doubt, names: Collection[str]
) -> Trial | None:
    begin = steps[index].before
    other = begin.copied()
    if other.time is None:  # there is nothing to doubt before the first sample of the IMU
        return None
    doubt(other)
    again: list[Step] = []
    missed = {name: MISSED * _count(name, steps[index:]) for name in names}
    for step in steps[index:]:
        done, other = replayed(other, [(step.readings, step.end)])
        again += done
        if any(_gated(name, begin, other) > most for name, most in missed.items()):
            return None
    if not all(_explained(name, begin, other) for name in names) or _rejected(other):
        return None
    return [*steps[:index], *again], other


def _count(name: str, steps: Sequence[Step]) -> int:
    """Samples of a sensor."""
    return sum(reading.name == name for step in steps for reading in step.readings)


def _gated(name: str, before: Estimator, after: Estimator) -> int:
    return after.tallies[name].gated - before.tallies[name].gated


def _rejected(estimator: Estimator) -> list[str]:
    """Names of the sensors whose last samples were not used."""
    return [name for name, tally in estimator.tallies.items() if tally.excluded]


def _explained(name: str, before: Estimator, after: Estimator) -> bool:
    """Whether the sensor's residuals are those of a filter that is right."""
    first, last = before.tallies[name], after.tallies[name]
    taken, rejected = last.accepted - first.accepted, _gated(name, before, after)
    limit = quantile(taken * after.size_of(name), LIKELY)
    return taken > 0 and rejected <= MISSED * taken and last.distance - first.distance <= limit
