"""A stream of samples of one topic against its rule: single values, and jumps between samples."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from uvms_core.plausibility.rule import Rule
from uvms_core.signals import Array

Sample = tuple[int, Array, Any]
"""Stamp (ns), values as one array, signal."""
AGREEING = 5
"""Samples that agree with each other, after which a jump is taken for real: a quarter of a second
of control ticks, half as long as the last good value is kept. An outlier is one sample or a few;
what stays there is where the vehicle is, and a check that refuses it for ever would blind the
node."""

_NONE = np.zeros(0)


class Watch:
    """Looks at the samples of one topic in the order of their stamps."""

    def __init__(self, rule: Rule) -> None:
        self.rule = rule
        """Bounds of the topic."""
        self.reset()

    def reset(self) -> None:
        """Forget all samples: what comes next may be anywhere."""
        self._last: Sample | None = None
        self._checked: tuple[Any, Array] | None = None
        self._refused: Sample | None = None
        self._agreeing = 0
        self.news: str | None = None
        """Said once, when a jump was taken for real."""

    def fault(self, stamp: int, signal: Any, is_checked: bool = False) -> str | None:
        """Why a sample cannot be used, in words; None where it can, which makes it the last one.

        Where it `is_checked`, its values are known to be within their bounds.
        """
        rule = self.rule
        if is_checked and not rule.jumps:
            return None
        if not rule.is_flat:
            if not is_checked and not rule.are_possible(signal) and (text := rule.explain(signal)):
                return text
            return self._step(stamp, signal) if rule.jumps else None
        x = rule.flat(signal)
        if not is_checked and not rule.is_possible(x):
            return rule.explain(signal)
        if not rule.jumps:
            return None
        sample, last = (stamp, x, signal), self._last
        if last is None:
            self._last = sample
            return None
        elapsed = stamp - last[0]
        if elapsed <= 0:
            return None  # a late sample: no time to compare with
        y = (x - last[1]) * rule.inverse(elapsed)
        if not y.dot(y) <= 1.0:
            text = self._jump(last, sample)
            if text is not None and not self._is_confirmed(sample, text):
                return text
        self._last, self._refused = sample, None
        return None

    def is_possible(self, signal: Any, values: Sequence[Any]) -> bool:
        """Whether a signal with these fields is within its bounds; it is remembered then."""
        x = self.rule.strung(values)
        if not self.rule.is_possible(x):
            return False
        self._checked = signal, x
        return True

    def follows(self, signal: Any) -> bool:
        """Whether the signal that is remembered certainly follows the last one; takes it then."""
        last, checked = self._last, self._checked
        if last is None or checked is None or checked[0] is not signal:
            return False
        stamp, x = signal.stamp, checked[1]
        if stamp <= last[0]:
            return False
        y = (x - last[1]) * self.rule.inverse(stamp - last[0])
        if not y.dot(y) <= 1.0:
            return False
        self._last, self._refused = (stamp, x, signal), None
        return True

    def _step(self, stamp: int, signal: Any) -> str | None:
        """As `fault`, for a signal of no fixed size within its bounds."""
        sample, last = (stamp, _NONE, signal), self._last
        if last is not None and stamp <= last[0]:
            return None
        if last is not None and (text := self._jump(last, sample)) is not None:
            if not self._is_confirmed(sample, text):
                return text
        self._last, self._refused = sample, None
        return None

    def are_good(self, signals: Sequence[Any]) -> bool:
        """Whether a run of samples is certainly good, which makes its last one the last one.

        One product for all of them; where it does not hold they are to be looked at one by one.
        """
        rule, last = self.rule, self._last
        if last is None or not rule.is_quick:
            return False
        stamps = [last[0], *(signal.stamp for signal in signals)]
        elapsed = stamps[1] - stamps[0]
        if elapsed <= 0 or any(b - a != elapsed for a, b in pairwise(stamps)):
            return False
        x = rule.rows(last[1], signals)
        y = x * rule.scale
        step = (x[1:] - x[:-1]) * rule.inverse(elapsed)
        if not (np.vdot(y, y) <= 1.0 and np.vdot(step, step) <= 1.0):
            return False
        self._last, self._refused = (stamps[-1], x[-1], signals[-1]), None
        return True

    def _is_confirmed(self, sample: Sample, text: str) -> bool:
        before, self._refused = self._refused, sample
        agrees = before is not None and self._jump(before, sample) is None
        self._agreeing = self._agreeing + 1 if agrees else 1
        if self._agreeing < AGREEING:
            return False
        self.news = f"{text}; {AGREEING} samples agree with each other, so that it is taken as real"
        return True

    def _jump(self, before: Sample, now: Sample) -> str | None:
        """The first value that changed more than it can; None where there is none."""
        rule, elapsed = self.rule, now[0] - before[0]
        if elapsed <= 0:
            return None
        if rule.step_fault is not None:
            return rule.step_fault(before[2], now[2])
        step, change = now[1] - before[1], rule.allowed(elapsed)
        if rule.turn is not None and now[1][rule.turn].dot(before[1][rule.turn]) < 0.0:
            step[rule.turn] = -now[1][rule.turn] - before[1][rule.turn]
        if rule.extra_slack is not None:
            change = change + rule.extra_slack(before[2], 1e-9 * elapsed)
        for i, far in enumerate(abs(step) > change):
            if far:
                return (
                    f"{rule.labels[i]} jumps by {step[i]:.3g} {rule.units[i]} in"
                    f" {1e-9 * elapsed:.3g} s; possible for this vehicle is {change[i]:.3g}"
                )
        return None
