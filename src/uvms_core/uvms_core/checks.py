"""Checks of signals: each is checked once, where it enters, and trusted after that.

A signal made from a message is checked on the way (`uvms_core.messages.fields`); one made in Python
by the first part that is given it (`check`). Both leave a mark on the signal, so that the next part
does not check it again: it looks only at stamps, and at sizes against its own vehicle.
`dataclasses.replace` makes a new signal without the mark.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, lru_cache
from itertools import chain
from math import isfinite
from operator import attrgetter
from typing import Any, NamedTuple, TypeVar, get_type_hints

import numpy as np

from uvms_core.errors import SignalError, StaleError
from uvms_core.signals import Array, OnlyIf, Shape, to_nanoseconds

QUATERNION_TOLERANCE = 1e-3
"""A quaternion from outside may be off unit length by this much; a zero one is invalid."""
ROUNDED = 0.02
"""A driver's quaternion that is rounded to two decimals is off unit length by up to this."""
MAX_AGE_S = 0.5
"""Oldest joint state or disturbance that control works with, s: a planner step."""
ATTITUDE_DEG = 30.0
"""Roll or pitch beyond which a controlled vehicle counts as lost. The planner lets it take up 5
degrees, its law saturates at 9 (`control.vehicle.error_scale`), and the worst that it still comes
back from in the scenarios, without the observer, is 15."""

_MARK = "_checked"
_set = object.__setattr__
"""Signals are frozen. To touch their `__dict__` would allocate one for each of them."""
_FLOAT64 = np.dtype(np.float64)
_DTYPE, _SHAPE = attrgetter("dtype"), attrgetter("shape")
S = TypeVar("S")
Names = Mapping[str, Sequence[str]]


def trust(signal: S) -> S:
    """The signal, marked as checked; for those who have checked what it is made of."""
    if type(signal) is not int:  # as the clock's stamp is
        _set(signal, _MARK, True)
    return signal


def trust_all(signals: tuple[S, ...]) -> tuple[S, ...]:
    """As `trust`, for several."""
    for signal in signals:
        _set(signal, _MARK, True)
    return signals


def is_trusted(signal: Any) -> bool:
    """Whether the signal has been checked."""
    return getattr(signal, _MARK, False)


def check(name: str, signal: Any, **names: Sequence[str]) -> None:
    """Check a signal by the annotations of its fields, unless that has been done; mark it.

    Args:
        name: of the signal, for errors.
        signal: dataclass with annotations of `uvms_core.signals`.
        names: by letter of a dimension, the names that the entries belong to:
            `n=vehicle.joint_names`. Sizes are compared in any case.

    Raises:
        SignalError: a field has a wrong type or shape, is not finite or not of unit length.
    """
    checked = is_trusted(signal)
    if checked and not names:
        return
    if not checked and not names and _are_certainly_good((signal,)):
        trust(signal)
        return
    kind: Any = type(signal)
    fields, sized = _fields(kind)
    if not checked:
        sizes = {letter: len(each) for letter, each in names.items()} if names else {}
        for field, rule in fields:
            value = getattr(signal, field)
            if not _is_good(value, rule, sizes):
                _explain(f"{name}.{field}", value, rule, sizes, names, signal)
        trust(signal)
    else:
        sizes = {letter: len(each) for letter, each in names.items()}
        for field, rule in sized:
            value = getattr(signal, field)
            if value.shape == (sizes.get(str(rule.sizes[0])),):  # the usual case, which is quick
                continue
            if not _fits(value.shape, rule, sizes):
                raise _wrong_shape(f"{name}.{field}", value, rule, sizes, names)


def trust_good(signals: Sequence[Any]) -> None:
    """Mark signals as checked if they are of one kind, and all of them certainly are good.

    `check` then has little to do; where they are not marked it says what is wrong.
    """
    if signals and not is_trusted(signals[0]) and _are_certainly_good(signals):
        trust_all(tuple(signals))


def well_formed(signal: Any) -> tuple[Array, ...] | None:
    """The values of the fields that have a rule, if their form certainly is as it must be.

    Types, shapes and unit lengths, that is; whether the numbers are finite is for the caller to
    see. Quick; None where only `check` can tell.
    """
    return _well_formed((signal,))


def checked_fields(kind: type) -> tuple[str, ...]:
    """Names of the fields that `check` looks at, in their order."""
    return tuple(name for name, _ in _fields(kind)[0])


def number(name: str, value: float) -> None:
    """SignalError unless the value is finite."""
    if not isfinite(value):
        raise SignalError(f"{name} is {value}; it must be finite")


def is_unit(squared: float) -> bool:
    """Whether a quaternion whose components' squares add up to this has unit length."""
    return abs(squared - 1.0) < 2.0 * QUATERNION_TOLERANCE


def later(name: str, stamp: int, than: int, of: str) -> None:
    """SignalError unless the stamp comes after another; both in ns."""
    if stamp <= than:
        raise SignalError(f"{name} is {stamp} ns; it must be after {of}, {than} ns")


def age(name: str, stamp: int, now: int, limit_s: float = MAX_AGE_S) -> None:
    """Check that an input of `stamp` can be used at `now` (both ns).

    Raises:
        StaleError: it is older than `limit_s`.
        SignalError: it is later than now.
    """
    if not 0 <= now - stamp <= to_nanoseconds(limit_s):
        error = StaleError if stamp < now else SignalError
        raise error(
            f"{name}: stamp {stamp} ns; it must lie within {limit_s:g} s before the odometry's,"
            f" {now} ns"
        )


@cache
def _fields(kind: type) -> tuple[tuple[tuple[str, Any], ...], tuple[tuple[str, Shape], ...]]:
    """Fields of a signal with their rules: all that have one, and those of a vehicle's size."""
    found = []
    for field, hint in get_type_hints(kind, include_extras=True).items():
        rules = [each for each in getattr(hint, "__metadata__", ()) if _is_rule(each)]
        if rules or hint is float:
            found.append((field, rules[0] if rules else None))
    sized = [
        (field, rule)
        for field, rule in found
        if isinstance(rule, Shape) and any(isinstance(size, str) for size in rule.sizes)
    ]
    return tuple(found), tuple(sized)


class _Layout(NamedTuple):
    """The fields of a signal that is made of arrays, for the quick test of all at once."""

    get: Callable[[Any], tuple[Any, ...]]
    types: list[type]
    dtypes: list[Any]
    units: list[int]  # which of them are vectors of unit length


@cache
def _layout(kind: type) -> _Layout | None:
    """None where some of the fields are numbers, or have rules that take a closer look."""
    fields, _ = _fields(kind)
    rules = [rule for _, rule in fields]
    if not fields or not all(isinstance(rule, Shape) for rule in rules):
        return None
    if any(rule.increasing or (rule.unit and len(rule.sizes) > 1) for rule in rules):
        return None
    names, count = [name for name, _ in fields], len(fields)
    get: Any = attrgetter(*names) if count > 1 else lambda signal: (getattr(signal, names[0]),)
    units = [index for index, rule in enumerate(rules) if rule.unit]
    return _Layout(get, [np.ndarray] * count, [_FLOAT64] * count, units)


@lru_cache(maxsize=256)
def _fit_together(kind: type, shapes: tuple[tuple[int, ...], ...]) -> bool:
    """Whether shapes of signals in a row are as their rules say; the few that occur are kept."""
    sizes: dict[str, int] = {}
    fields = _fields(kind)[0]
    rules = [rule for _, rule in fields] * (len(shapes) // len(fields))
    return all(_fits(shape, rule, sizes) for shape, rule in zip(shapes, rules, strict=True))


def _well_formed(signals: Sequence[Any]) -> tuple[Array, ...] | None:
    """As `well_formed`, of several signals in a row; None as well where they are unlike."""
    kind: Any = type(signals[0])
    count = len(signals)
    layout = _layout(kind)
    if layout is None or (count > 1 and set(map(type, signals)) != {kind}):
        return None
    values: tuple[Array, ...] = tuple(chain.from_iterable(map(layout.get, signals)))
    if list(map(type, values)) != count * layout.types:
        return None
    if list(map(_DTYPE, values)) != count * layout.dtypes:
        return None
    if not _fit_together(kind, tuple(map(_SHAPE, values))):
        return None
    for index in layout.units:
        for value in values[index :: len(layout.types)]:
            if not is_unit(value.dot(value)):
                return None
    return values


def _are_certainly_good(signals: Sequence[Any]) -> bool:
    values = _well_formed(signals)
    if values is None:
        return False
    numbers = np.concatenate(values, axis=None)
    return isfinite(numbers.dot(numbers))


def _is_rule(item: Any) -> bool:
    return isinstance(item, Shape | OnlyIf)


def _is_good(value: Any, rule: Any, sizes: dict[str, int]) -> bool:
    """The fast test: whether there is certainly nothing to explain."""
    if type(rule) is not Shape:
        return isfinite(value)
    if type(value) is not np.ndarray or value.dtype != _FLOAT64:
        return False
    shape = value.shape
    if shape != rule.sizes and not _fits(shape, rule, sizes):
        return False
    if len(shape) == 1:
        squared: float = value.dot(value)
        if rule.unit:
            return is_unit(squared)
    else:
        squared = float(np.vdot(value, value))
    return isfinite(squared) and not (rule.unit or rule.increasing)


def _explain(
    name: str, value: Any, rule: Any, sizes: dict[str, int], names: Names, signal: Any
) -> None:
    """The slow test, in words: SignalError for the first thing that is wrong."""
    if isinstance(rule, Shape):
        _explain_array(name, value, rule, sizes, names)
    elif rule is None or getattr(signal, rule.field):
        number(name, value)


def _explain_array(name: str, value: Any, rule: Shape, sizes: dict[str, int], names: Names) -> None:
    if not isinstance(value, np.ndarray) or value.dtype != np.float64:
        kind = value.dtype if isinstance(value, np.ndarray) else type(value).__name__
        raise SignalError(f"{name} has type {kind}; it must be an array of float64")
    if not _fits(value.shape, rule, sizes):
        raise _wrong_shape(name, value, rule, sizes, names)
    if not np.isfinite(value).all():
        raise _not_finite(name, value, rule, names)
    if rule.unit:
        _check_unit(name, value)
    if rule.increasing and (value[0] != 0.0 or (np.diff(value) <= 0.0).any()):
        raise SignalError(f"{name} is {value}; it must increase from 0")


def _fits(shape: tuple[int, ...], rule: Shape, sizes: dict[str, int]) -> bool:
    """Whether a shape is as the rule says; a letter stands for the first size, not 0."""
    if len(shape) != len(rule.sizes):
        return False
    if len(shape) == 1 and isinstance(rule.sizes[0], str):  # the usual case, which is quick
        return bool(shape[0]) and sizes.setdefault(rule.sizes[0], shape[0]) == shape[0]
    for size, count in zip(rule.sizes, shape, strict=True):
        if isinstance(size, str):
            if not count or sizes.setdefault(size, count) != count:
                return False
        elif size != count:
            return False
    return True


def _wrong_shape(
    name: str, value: Array, rule: Shape, sizes: dict[str, int], names: Names
) -> SignalError:
    wanted = [str(sizes.get(str(size), size)) for size in rule.sizes]
    shape = f"({', '.join(wanted)}{',' if len(wanted) == 1 else ''})"
    whose = "".join(f" for {', '.join(names[str(s)])}" for s in rule.sizes if s in names)
    free = [size for size in rule.sizes if isinstance(size, str) and size not in sizes]
    least = "".join(f", {size} >= 1" for size in free)
    return SignalError(f"{name} has shape {value.shape}; it must have {shape}{least}{whose}")


def _check_unit(name: str, value: Array) -> None:
    rows = value.reshape(-1, value.shape[-1])
    for row, squared in enumerate(np.einsum("ij,ij->i", rows, rows)):
        if not is_unit(squared):
            where = f"[{row}]" if value.ndim > 1 else ""
            raise SignalError(f"{name}{where} has length {squared**0.5:g}; it must be 1")


def _not_finite(name: str, value: Array, rule: Shape, names: Names) -> SignalError:
    where = tuple(int(i) for i in np.argwhere(~np.isfinite(value))[0])
    index = ", ".join(
        names[str(size)][i] if size in names else str(i)
        for size, i in zip(rule.sizes, where, strict=True)
    )
    return SignalError(f"{name}[{index}] is {value[where]}; it must be finite")
