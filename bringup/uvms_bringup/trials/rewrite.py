"""Put numbers into the text of a YAML file and leave every other letter as it is."""

from collections.abc import Mapping

import numpy as np
import yaml

DIGITS = 5
"""Significant digits written: an identified number has two or three that mean anything."""


def rewritten(text: str, values: Mapping[str, float]) -> str:
    """The text with the number at each dotted path replaced; comments and layout stay."""
    root = yaml.compose(text, Loader=yaml.SafeLoader)
    spans = []
    for path, value in values.items():
        node = _node(root, path)
        spans.append((node.start_mark.index, node.end_mark.index, _number(value)))
    for begin, end, number in sorted(spans, reverse=True):
        text = text[:begin] + number + text[end:]
    return text


def _number(value: float) -> str:
    return np.format_float_positional(
        value + 0.0, precision=DIGITS, unique=False, fractional=False, trim="0"
    )


def _node(node: yaml.Node | None, path: str) -> yaml.ScalarNode:
    for part in path.split("."):
        if isinstance(node, yaml.SequenceNode):
            node = node.value[int(part)]
        elif isinstance(node, yaml.MappingNode):
            node = next((value for key, value in node.value if key.value == part), None)
    if not isinstance(node, yaml.ScalarNode):
        raise KeyError(path)
    return node
