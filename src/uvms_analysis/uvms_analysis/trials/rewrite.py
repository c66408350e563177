"""Replace numbers in the text of a YAML file, leaving every other character as it is."""

import math
from collections.abc import Mapping

import numpy as np
import yaml

STEPS_PER_ERROR = 30.0
"""Least number of steps of the last digit in a standard error, so that rounding is harmless."""


def rewritten(text: str, values: Mapping[str, tuple[float, float]]) -> str:
    """The text with the number at each dotted path replaced; comments and layout stay.

    values: the number and its standard error, which determines how many digits are written.
    """
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    spans = []
    for path, (value, error) in values.items():
        node = _node(root, path)
        spans.append((node.start_mark.index, node.end_mark.index, _number(value, error)))
    for begin, end, number in sorted(spans, reverse=True):
        text = text[:begin] + number + text[end:]
    return text


def _number(value: float, error: float) -> str:
    decimals = max(1, math.ceil(math.log10(STEPS_PER_ERROR / error)))
    return np.format_float_positional(round(value, decimals) + 0.0, trim="0")


def _node(node: yaml.Node | None, path: str) -> yaml.ScalarNode:
    for part in path.split("."):
        if isinstance(node, yaml.SequenceNode):
            node = node.value[int(part)]
        elif isinstance(node, yaml.MappingNode):
            node = next((value for key, value in node.value if key.value == part), None)
    if not isinstance(node, yaml.ScalarNode):
        raise KeyError(path)
    return node
