"""The bounds of one kind of signal, and the quick test of a whole signal against them.

The values of a signal are strung together as one flat array x. With the middle c and the half
width h of every bound, y = (x - c) / h must be within [-1, 1]. The quick test is y . y <= 1: bounds
are many times wider than what a vehicle does, so that it almost always holds, and it takes one
product instead of a comparison for each field. Only where it fails the values are looked at one by
one.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

import numpy as np

from uvms_core import checks
from uvms_core.signals import Array

Values = Array | float
UNBOUNDED = float("inf")


@dataclass(frozen=True)
class Bound:
    """Bound of one field; numbers hold for all of its values, arrays for one each.

    Args:
        field: of the signal.
        low: least value that is possible.
        high: greatest.
        size: number of values of the field; 0: any, where the signal has no fixed size.
        unit: for messages.
        rate: how fast the value can change, per s.
        slack: how much it may change beside that from sample to sample: noise and resolution.
        only_if: field that must be true for this bound to hold.
        is_matrix: the field has two dimensions.
    """

    field: str
    low: Values
    high: Values
    size: int
    unit: str
    rate: Values = UNBOUNDED
    slack: Values = 0.0
    only_if: str = ""
    is_matrix: bool = False


def within(field: str, limit: Values, size: int, unit: str, **more: Any) -> Bound:
    """A bound that is the same in both directions."""
    return Bound(field, -np.asarray(limit), np.asarray(limit), size, unit, **more)


class Rule:
    """Bounds of a kind of signal.

    Args:
        bounds: of its fields. All of them have a size, or none has.
        quaternion: field that is the same with the opposite sign.
        extra_slack: by how much the next sample, so many seconds later, may jump beyond the slack
            of the bounds, by value: a sample's own uncertainty. Called only where a jump is too
            large without it.
        step_fault: why a signal of no fixed size cannot follow another one, in words.
    """

    def __init__(
        self,
        bounds: Sequence[Bound],
        quaternion: str = "",
        extra_slack: Callable[[Any, float], Array] | None = None,
        step_fault: Callable[[Any, Any], str | None] | None = None,
    ) -> None:
        self.bounds = tuple(bounds)
        self.step_fault = step_fault
        self.extra_slack = extra_slack
        self.jumps = step_fault is not None
        self._covered: dict[type, bool] = {}
        self.is_flat = all(bound.size for bound in bounds) and bool(bounds)
        if not self.is_flat:
            self._by_field = [
                (bound.field, 0.5 * (high + low), 2.0 / (high - low), bound.only_if)
                for bound in bounds
                for low, high in [(np.asarray(bound.low), np.asarray(bound.high))]
            ]
            return
        self._get = attrgetter(*(bound.field for bound in bounds))
        self._single = len(bounds) == 1
        self._scalar = all(bound.size == 1 for bound in bounds)
        self._straight = not (self._single or self._scalar) and not any(
            bound.is_matrix for bound in bounds
        )
        self.low, self.high = self._column("low"), self._column("high")
        self.rate, self.slack = self._column("rate"), self._column("slack")
        self._middle = 0.5 * (self.low + self.high)
        self.scale = 2.0 / (self.high - self.low)
        self._centred = not self._middle.any()
        self.jumps = bool(np.isfinite(self.rate).any())
        self.labels = [
            bound.field if bound.size == 1 else f"{bound.field}[{i}]"
            for bound in bounds
            for i in range(bound.size)
        ]
        self.units = [bound.unit for bound in bounds for _ in range(bound.size)]
        self.turn = self._place(quaternion)
        self._inverse: dict[int, Array] = {}

    def flat(self, signal: Any) -> Array:
        """The values of a signal as one array."""
        return self.strung(self.values(signal))

    def values(self, signal: Any) -> Sequence[Any]:
        """The bounded fields of a signal."""
        values: Any = self._get(signal)
        return (values,) if self._single else values

    def strung(self, values: Sequence[Any]) -> Array:
        """The values of all bounded fields, in their order, as one array."""
        if self._straight:
            return np.concatenate(values)
        if self._scalar:
            return np.array(values, dtype=np.float64).ravel()
        if self._single:
            value = values[0]
            return value if value.ndim == 1 else value.ravel()
        return np.concatenate([value.ravel() for value in values])

    def covers(self, kind: type) -> bool:
        """Whether it bounds, in one flat array, just what a class of signals is checked for.

        Then what is within bounds is finite too, and `checks.well_formed` gives what to string
        together.
        """
        found = self._covered.get(kind)
        if found is None:
            bounded = tuple(bound.field for bound in self.bounds)
            found = self._covered[kind] = self.is_flat and checks.checked_fields(kind) == bounded
        return found

    @property
    def is_quick(self) -> bool:
        """Whether several samples can be tested at once."""
        return self.is_flat and self.jumps and self._centred and self._straight

    def rows(self, first: Array, signals: Sequence[Any]) -> Array:
        """A flat array and those of several signals below it, a row each."""
        values = [first]
        for signal in signals:
            values.extend(self._get(signal))
        return np.concatenate(values).reshape(-1, first.size)

    def is_possible(self, x: Array) -> bool:
        """Whether all values are within their bounds; False for NaN."""
        y = x * self.scale if self._centred else (x - self._middle) * self.scale
        return y.dot(y) <= 1.0 or bool(((x >= self.low) & (x <= self.high)).all())

    def are_possible(self, signal: Any) -> bool:
        """Whether the fields of a signal of no fixed size are certainly within their bounds."""
        for field, middle, scale, only_if in self._by_field:
            if only_if and not getattr(signal, only_if):
                continue
            y = (getattr(signal, field) - middle) * scale
            if not np.vdot(y, y) <= 1.0:
                return False
        return True

    def allowed(self, elapsed: int) -> Array:
        """Largest change over a time in ns."""
        return self.slack + self.rate * (1e-9 * elapsed)

    def inverse(self, elapsed: int) -> Array:
        """1 / `allowed`; the few that occur are kept."""
        found = self._inverse.get(elapsed)
        if found is None:
            if len(self._inverse) > 16:
                self._inverse.clear()
            found = self._inverse[elapsed] = 1.0 / self.allowed(elapsed)
        return found

    def explain(self, signal: Any) -> str | None:
        """The first value that is not possible, in words; None where all are."""
        for bound in self.bounds:
            if bound.only_if and not getattr(signal, bound.only_if):
                continue
            values = np.atleast_1d(np.asarray(getattr(signal, bound.field), dtype=np.float64))
            low = np.broadcast_to(bound.low, values.shape)
            high = np.broadcast_to(bound.high, values.shape)
            wrong = np.argwhere(~((values >= low) & (values <= high)))
            if len(wrong):
                at = tuple(int(i) for i in wrong[0])
                index = "" if values.size == 1 else f"[{', '.join(map(str, at))}]"
                return (
                    f"{bound.field}{index} is {values[at]:g} {bound.unit}; possible for this"
                    f" vehicle is {low[at]:g} to {high[at]:g}"
                )
        return None

    def _column(self, name: str) -> Array:
        return np.concatenate(
            [
                np.broadcast_to(np.asarray(getattr(bound, name), float).ravel(), (bound.size,))
                for bound in self.bounds
            ]
        )

    def _place(self, field: str) -> slice | None:
        start = 0
        for bound in self.bounds:
            if bound.field == field:
                return slice(start, start + bound.size)
            start += bound.size
        return None
