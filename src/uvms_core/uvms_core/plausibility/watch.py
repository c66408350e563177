"""A stream of samples of one topic against its rule: single values, and jumps between samples."""

from typing import Any

from uvms_core.plausibility.rule import Rule
from uvms_core.signals import Array

Sample = tuple[int, Array, Any]
"""Stamp (ns), values as one array, signal."""
AGREEING = 5
"""Samples that agree with each other, after which a jump is taken for real: a quarter of a second
of control ticks, half as long as the last good value is kept. An outlier is one sample or a few;
what stays there is where the vehicle is, and a check that refuses it for ever would blind the
node."""


class Watch:
    """Looks at the samples of one topic in the order of their stamps."""

    def __init__(self, rule: Rule) -> None:
        self._rule = rule
        self.reset()

    def reset(self) -> None:
        """Forget all samples: what comes next may be anywhere."""
        self._last: Sample | None = None
        self._refused: Sample | None = None
        self._agreeing = 0
        self.news: str | None = None
        """Said once, when a jump was taken for real."""

    def fault(self, stamp: int, signal: Any) -> str | None:
        """Why a sample cannot be used, in words; None where it can, which makes it the last one."""
        rule = self._rule
        if not rule.is_flat:
            return rule.explain(signal)
        x = rule.flat(signal)
        if not rule.is_possible(x):
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
        rule, elapsed = self._rule, now[0] - before[0]
        if elapsed <= 0:
            return None
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
