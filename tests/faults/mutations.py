"""Seeded damage to YAML files: to their values, their keys, their lines and their bytes."""

import copy
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import yaml

Place = tuple[Any, Any]
"""A mapping or list, and the key or number of one of its values."""

FACTORS = (-1.0, 0.0, 1e-3, 0.1, 10.0, 1e3, 1e6, 1e30, 1e300)
STRANGE: tuple[Any, ...] = (
    float("nan"),
    float("inf"),
    -float("inf"),
    1e308,
    -1e308,
    5e-324,
    10**400,
    2**63,
    True,
    None,
    "",
    "many",
    "trim",
    "1e",
    [],
    {},
    [1.0],
    [[1.0, 2.0], [3.0]],
    {"a": 1.0},
    [None, None, None],
    ["x", "y", "z"],
)


def places(node: Any, kinds: type | tuple[type, ...]) -> list[Place]:
    """Where values of these kinds are, in mappings and lists, from the top down."""
    items = node.items() if isinstance(node, dict) else enumerate(node)
    found: list[Place] = []
    for key, value in list(items):
        if isinstance(value, kinds) and not isinstance(value, bool):
            found.append((node, key))
        if isinstance(value, dict | list):
            found += places(value, kinds)
    return found


def _pick(rng: np.random.Generator, items: list[Any]) -> Any:
    return items[int(rng.integers(len(items)))]


def scale_a_number(data: Any, rng: np.random.Generator) -> None:
    node, key = _pick(rng, places(data, (int, float)))
    node[key] *= _pick(rng, list(FACTORS))


def replace_a_value(data: Any, rng: np.random.Generator) -> None:
    node, key = _pick(rng, places(data, object))
    node[key] = copy.deepcopy(_pick(rng, list(STRANGE)))


def drop_a_key(data: Any, rng: np.random.Generator) -> None:
    node, key = _pick(rng, places(data, object))
    del node[key]


def rename_a_key(data: Any, rng: np.random.Generator) -> None:
    mappings = [place for place in places(data, object) if isinstance(place[0], dict)]
    node, key = _pick(rng, mappings)
    node[_pick(rng, [f"{key}_", str(key)[:-1], 7, None, "name"])] = node.pop(key)


def double_an_item(data: Any, rng: np.random.Generator) -> None:
    node, key = _pick(rng, places(data, list))
    if node[key]:
        node[key].append(copy.deepcopy(_pick(rng, node[key])))


def swap_two_values(data: Any, rng: np.random.Generator) -> None:
    (a, i), (b, j) = (_pick(rng, places(data, object)) for _ in range(2))
    a[i], b[j] = copy.deepcopy(b[j]), copy.deepcopy(a[i])


OF_DATA: tuple[Callable[[Any, np.random.Generator], None], ...] = (
    scale_a_number,
    scale_a_number,
    replace_a_value,
    replace_a_value,
    drop_a_key,
    rename_a_key,
    double_an_item,
    swap_two_values,
)


def cut_lines(lines: list[bytes], rng: np.random.Generator) -> list[bytes]:
    at = int(rng.integers(len(lines)))
    return lines[:at] + lines[at + int(rng.integers(1, 6)) :]


def double_a_line(lines: list[bytes], rng: np.random.Generator) -> list[bytes]:
    at = int(rng.integers(len(lines)))
    return [*lines[: at + 1], *lines[at:]]


def shuffle_lines(lines: list[bytes], rng: np.random.Generator) -> list[bytes]:
    at = int(rng.integers(len(lines)))
    part = lines[at : at + 5]
    return lines[:at] + [part[k] for k in rng.permutation(len(part))] + lines[at + 5 :]


def flip_bits(lines: list[bytes], rng: np.random.Generator) -> list[bytes]:
    raw = bytearray(b"\n".join(lines))
    for _ in range(int(rng.integers(1, 4))):
        raw[int(rng.integers(len(raw)))] ^= 1 << int(rng.integers(8))
    return [bytes(raw)]


def end_early(lines: list[bytes], rng: np.random.Generator) -> list[bytes]:
    raw = b"\n".join(lines)
    return [raw[: int(rng.integers(len(raw)))]]


OF_LINES: tuple[Callable[[list[bytes], np.random.Generator], list[bytes]], ...] = (
    cut_lines,
    double_a_line,
    shuffle_lines,
    flip_bits,
    flip_bits,
    end_early,
)


def mutated(text: str, rng: np.random.Generator) -> tuple[str, bytes]:
    """A damaged copy of a YAML file, and the names of what was done to it."""
    names, done = [], text
    if rng.random() < 0.6:
        data = yaml.safe_load(text)
        for _ in range(int(rng.integers(1, 3))):
            change = _pick(rng, list(OF_DATA))
            names.append(change.__name__)
            change(data, rng)
        return " and ".join(names), yaml.safe_dump(data, sort_keys=False).encode()
    damage = _pick(rng, list(OF_LINES))
    return damage.__name__, b"\n".join(damage(done.encode().split(b"\n"), rng))


def cases(texts: list[str], count: int, seed: int) -> Iterator[tuple[str, bytes]]:
    """So many damaged files, in turn of each text; the same for a seed."""
    for number in range(count):
        yield mutated(texts[number % len(texts)], np.random.default_rng((seed, number)))
