"""Sensors that read the same to the last bit, sample after sample: that is no measurement."""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array


class Repeated(NamedTuple):
    """The last reading of a sensor, and how many times in a row it has come."""

    values: Array
    times: int = 1


def repeated(last: Repeated | None, values: Array) -> Repeated:
    """With one reading more."""
    same = last is not None and np.array_equal(last.values, values)
    return Repeated(values, last.times + 1 if last is not None and same else 1)
