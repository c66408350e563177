"""Faults of sensors on their way from the model to the message.

They work on the fields of the samples, whatever the sensor: numbers, vectors and attitudes. The
covariances stay as they are, because a sensor does not know of its fault.
"""

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from uvms_core.checks import trust
from uvms_core.rng import generator
from uvms_core.signals import Array, to_nanoseconds
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat
from uvms_dynamics.simulation.events.measured import is_attitude, rules_of
from uvms_dynamics.simulation.events.sensor import (
    BiasFault,
    LatencyFault,
    NoiseFault,
    OutlierFault,
    ScaleFault,
    SensorEvent,
    SilentFault,
    StuckFault,
    ZerosFault,
)

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


class Fault(ABC):
    """A fault of one sensor between two stamps."""

    delay = 0
    """How much later a sample comes than it would without the fault, ns."""

    def __init__(self, event: SensorEvent, rng: np.random.Generator) -> None:
        self._begin = to_nanoseconds(event.at_s)
        self._end = None if event.until_s is None else to_nanoseconds(event.until_s)
        self.event, self.rng = event, rng

    def covers(self, stamp: int) -> bool:
        """Whether it concerns a sample."""
        return self._begin <= stamp and (self._end is None or stamp < self._end)

    def see(self, sample: Any) -> None:
        """A sample before it begins, or after it ended."""
        return None

    @abstractmethod
    def change(self, sample: Any) -> Any:
        """What becomes of a sample; None: it does not come."""


class Silent(Fault):
    """No sample comes."""

    def change(self, sample: Any) -> Any:
        """Nothing."""
        return None


class Late(Fault):
    """Samples come later."""

    def __init__(self, event: LatencyFault, rng: np.random.Generator) -> None:
        super().__init__(event, rng)
        self.delay = to_nanoseconds(event.latency_s)

    def change(self, sample: Any) -> Any:
        """The sample itself."""
        return sample


class Stuck(Fault):
    """The last sample again, or that quantity of it."""

    def __init__(self, event: StuckFault, rng: np.random.Generator) -> None:
        super().__init__(event, rng)
        self._field = event.field
        self._last: Any = None

    def see(self, sample: Any) -> None:
        """Remember what the sensor will be stuck at."""
        self._last = sample

    def change(self, sample: Any) -> Any:
        """With the new stamp; the first sample where there was none before."""
        if self._last is None:
            self._last = sample
        if not self._field:
            return replace(self._last, stamp=sample.stamp)
        return replace(sample, **{self._field: getattr(self._last, self._field)})


class Altered(Fault):
    """Each quantity that is concerned becomes another."""

    def __init__(self, event: Any, rng: np.random.Generator) -> None:
        super().__init__(event, rng)
        self._field = event.field

    def change(self, sample: Any) -> Any:
        """A sample with other values."""
        kind: type = type(sample)
        names = [self._field] if self._field else list(rules_of(kind))
        values = {
            name: self.turned(getattr(sample, name))
            if is_attitude(kind, name)
            else self.altered(getattr(sample, name))
            for name in names
        }
        return replace(sample, **values)

    @abstractmethod
    def altered(self, value: Any) -> Any:
        """What becomes of a number or a vector."""

    @abstractmethod
    def turned(self, quaternion: Array) -> Array:
        """What becomes of an attitude."""


class Zeros(Altered):
    """All zero."""

    def altered(self, value: Any) -> Any:
        """0."""
        return np.zeros_like(value) if isinstance(value, np.ndarray) else 0.0

    def turned(self, quaternion: Array) -> Array:
        """Level and north."""
        return LEVEL.copy()


class Scaled(Altered):
    """Times a factor."""

    def altered(self, value: Any) -> Any:
        """X s."""
        return _like(value, np.array(self.event.size) * value)  # type: ignore[attr-defined]

    def turned(self, quaternion: Array) -> Array:
        """An attitude has no scale."""
        return quaternion


class Added(Altered):
    """An error is added; to an attitude as a turn about the body axes."""

    def altered(self, value: Any) -> Any:
        """X + e."""
        return _like(value, value + self.error(np.size(value)))

    def turned(self, quaternion: Array) -> Array:
        """Q exp(e)."""
        return quat_multiply(quaternion, rotation_vector_to_quat(self.error(3)))

    @property
    def size(self) -> Array:
        """Of the error."""
        return np.array(self.event.size, dtype=np.float64)  # type: ignore[attr-defined]

    @abstractmethod
    def error(self, count: int) -> Array:
        """The error (count,)."""


class Biased(Added):
    """The same error always."""

    def error(self, count: int) -> Array:
        """B."""
        return np.broadcast_to(self.size, (count,)).copy()


class Noisy(Added):
    """A normal error in each sample."""

    def error(self, count: int) -> Array:
        """S w."""
        return self.size * self.rng.standard_normal(count)


class Outliers(Added):
    """A normal error in some samples."""

    def __init__(self, event: OutlierFault, rng: np.random.Generator) -> None:
        super().__init__(event, rng)
        self._rate = event.rate

    def error(self, count: int) -> Array:
        """Of most samples none."""
        is_one, draws = self.rng.random() < self._rate, self.rng.standard_normal(count)
        return self.size * draws if is_one else np.zeros(count)


def _like(value: Any, result: Any) -> Any:
    return result if isinstance(value, np.ndarray) else float(np.ravel(result)[0])


MAKERS: dict[type[SensorEvent], Callable[..., Fault]] = {
    SilentFault: Silent,
    LatencyFault: Late,
    ZerosFault: Zeros,
    StuckFault: Stuck,
    BiasFault: Biased,
    NoiseFault: Noisy,
    OutlierFault: Outliers,
    ScaleFault: Scaled,
}


class FaultLine:
    """What comes of one sensor's samples: changed, lost, or later, but in order.

    Args:
        seed: of the run; each fault has random numbers of its own.
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._faults: list[Fault] = []
        self._alike: dict[str, int] = {}
        self._waiting: deque[tuple[int, Any]] = deque()
        self._last = -1

    def add(self, event: SensorEvent) -> None:
        """A fault more.

        Its random numbers go by sensor, kind and begin, and by its number among faults that are
        alike in these: no other event changes them.
        """
        key = f"{event.sensor}/{event.fault}/{to_nanoseconds(event.at_s)}"
        self._alike[key] = self._alike.get(key, -1) + 1
        rng = generator(self._seed, f"events/{key}/{self._alike[key]}")
        self._faults.append(MAKERS[type(event)](event, rng))

    def pass_on(self, arrivals: Sequence[tuple[int, Any]], now: int) -> tuple[Any, ...]:
        """The samples that have come by `now`, ns.

        `arrivals` are those that the sensor has delivered since the last call, with the time, ns,
        at which they come without faults: its own latency is in it.
        """
        for arrival, sample in arrivals:
            self._take(arrival, sample)
        ready = []
        while self._waiting and self._waiting[0][0] <= now:
            ready.append(trust(self._waiting.popleft()[1]))
        return tuple(ready)

    def _take(self, arrival: int, sample: Any) -> None:
        for fault in self._faults:
            if not fault.covers(sample.stamp):
                fault.see(sample)
                continue
            arrival += fault.delay
            sample = fault.change(sample)
            if sample is None:
                return
        self._last = max(self._last, arrival)
        self._waiting.append((self._last, sample))
