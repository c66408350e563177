"""Sensors that read the same to the last bit, sample after sample: that is no measurement."""

from typing import Any, NamedTuple

from uvms_observer.navigation.measurements.base import Measurement


class Repeated(NamedTuple):
    """The last reading of a sensor, and how many times in a row it has come."""

    values: list[float]
    times: int


def is_stuck(last: dict[str, Repeated], name: str, measurement: Measurement, sample: Any) -> bool:
    """Whether a sample is one too many; `last` readings by sensor are kept up to date."""
    if measurement.most_alike is None:
        return False
    values, before = measurement.reading(sample).tolist(), last.get(name)
    same = before is not None and before.values == values
    last[name] = Repeated(values, before.times + 1 if before is not None and same else 1)
    return last[name].times > measurement.most_alike
