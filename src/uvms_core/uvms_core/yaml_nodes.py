"""Checks the nodes of a YAML text before data are made of them.

A node that an alias repeats is one object, so all of them are looked at once however often they
are repeated. Merging, and hashing a key that is a list, would go through every repetition: a text
of 400 characters can stand for a billion.
"""

from typing import Any

MAX_VALUES = 100_000
"""Values in a file at most, each alias counted with all that it stands for."""

MAX_DIGITS = 400
"""Longest number: the greatest double has 309 digits, and the time that Python takes to read an
integer grows with the square of their count."""

_PREFIX = "tag:yaml.org,2002:"
_PLAIN = ("null", "bool", "int", "float", "str", "seq", "map", "merge", "timestamp", "value")
_NUMBERS = (f"{_PREFIX}int", f"{_PREFIX}float")
_DATE = f"{_PREFIX}timestamp"
_LONGEST_ECHO = 40


class NodeError(ValueError):
    """A node that is not read; carries the place in the text, as the reader's own errors do."""

    def __init__(self, problem: str, node: Any) -> None:
        super().__init__(problem)
        self.problem, self.problem_mark = problem, node.start_mark


def check_nodes(root: Any) -> list[Any]:
    """Check all nodes below `root`; returns those that YAML 1.1 reads as dates.

    Raises:
        NodeError: a tag, key or number that is not read.
        ValueError: more than MAX_VALUES values, counting what aliases repeat.
    """
    sizes: dict[int, int] = {}
    dates: list[Any] = []
    if _size(root, sizes, dates) > MAX_VALUES:
        raise ValueError(f"it has more than {MAX_VALUES} values, counting what aliases repeat")
    return dates


def _size(node: Any, sizes: dict[int, int], dates: list[Any]) -> int:
    """Number of values that a node stands for."""
    if id(node) in sizes:
        return sizes[id(node)]
    sizes[id(node)] = MAX_VALUES  # of a node that contains itself
    _check_tag(node)
    if isinstance(node.value, str):
        _check_scalar(node, dates)
        inner: list[Any] = []
    elif node.value and isinstance(node.value[0], tuple):
        for key, _ in node.value:
            _check_key(key)
        inner = [part for pair in node.value for part in pair]
    else:
        inner = node.value
    total = 1 + sum(_size(each, sizes, dates) for each in inner)
    sizes[id(node)] = min(total, MAX_VALUES + 1)  # no numbers of a thousand digits
    return sizes[id(node)]


def _check_tag(node: Any) -> None:
    """No other kinds of data than JSON has (and no Python objects)."""
    tag = str(node.tag)
    if tag.removeprefix(_PREFIX) not in _PLAIN or not tag.startswith(_PREFIX):
        name = tag.replace(_PREFIX, "!!")
        raise NodeError(f"could not determine a constructor for the tag {name!r}", node)


def _check_key(key: Any) -> None:
    if not isinstance(key.value, str):
        raise NodeError("a name must be one word or number, and this one is a group", key)


def _check_scalar(node: Any, dates: list[Any]) -> None:
    tag, text = str(node.tag), node.value
    if tag in _NUMBERS and len(text) > MAX_DIGITS:
        raise NodeError(
            f"a number of {len(text)} characters, {text[:_LONGEST_ECHO]}...: at most {MAX_DIGITS}",
            node,
        )
    if tag == _DATE:
        dates.append(node)
