"""What the loader took for the rounding of print, and evened out."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import BaseModel


def rounding_notes(data: Any, model: BaseModel, path: str = "") -> Iterator[str]:
    """A line for each matrix that was made symmetric and each direction that was made a unit one.

    Nothing else that a file gives is changed, so any difference in a list of numbers is one of
    these. `data` is what the file says, `model` what was made of it.
    """
    if not isinstance(data, Mapping):
        return
    for name, value in model:
        inner = f"{path}.{name}" if path else name
        yield from _notes(data.get(name), value, inner)


def _notes(given: Any, taken: Any, path: str) -> Iterator[str]:
    if isinstance(taken, BaseModel):
        yield from rounding_notes(given, taken, path)
    elif not (_is_list(given) and isinstance(taken, tuple)) or len(given) != len(taken):
        return
    elif all(isinstance(each, float) for each in taken):
        yield from _unit_note(given, taken, path)
    elif all(_is_list(row) and len(row) == len(taken) for row in given):
        yield from _symmetry_notes(given, taken, path)
    else:
        for number, (inner, each) in enumerate(zip(given, taken, strict=True)):
            yield from _notes(inner, each, f"{path}.{number}")


def _unit_note(given: Sequence[Any], taken: tuple[float, ...], path: str) -> Iterator[str]:
    numbers = [float(x) for x in given if not isinstance(x, str)]
    if len(numbers) == len(taken) and tuple(numbers) != taken:
        yield f"{path}: its length is {math.hypot(*numbers):.6g}; divided by it, to a unit vector"


def _symmetry_notes(given: Sequence[Any], taken: tuple[Any, ...], path: str) -> Iterator[str]:
    for i, row in enumerate(taken):
        for j in range(i):
            pair = float(given[j][i]), float(given[i][j])
            if pair != (taken[j][i], row[j]):
                yield (
                    f"{path}: row {j + 1}, column {i + 1} is {pair[0]:g} and row {i + 1}, column"
                    f" {j + 1} is {pair[1]:g}; both taken as {row[j]:g}"
                )


def _is_list(value: Any) -> bool:
    return isinstance(value, list | tuple)
