"""When samples come, and whether: latency and drop-outs of one sensor."""

from collections import deque
from collections.abc import Sequence
from typing import Any

from uvms_core.rng import generator
from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle.sensors import Sensor


class Delivery:
    """Holds samples back for the sensor's latency, and loses some.

    A sample keeps its own stamp. Those of t = 0 come at once: the instruments run when a run
    begins. `latency` (ns) and `drop_out_rate` may be changed at any time; samples that are on their
    way come when they would have.

    Args:
        name: of the sensor.
        section: its section of the vehicle file.
        seed: of the run.
    """

    def __init__(self, name: str, section: Sensor, seed: int) -> None:
        self.latency = to_nanoseconds(section.latency_s)
        self.drop_out_rate = section.drop_out_rate
        self._rng = generator(seed, f"sensors/{name}/drop-outs")
        self._waiting: deque[tuple[int, Any]] = deque()

    def deliver(self, samples: Sequence[Any], now: int) -> tuple[Any, ...]:
        """What comes up to `now`, ns, in order, when the sensor has made these samples."""
        if not (self.latency or self.drop_out_rate or self._waiting):
            return tuple(samples)
        return tuple(sample for _, sample in self.arrivals(samples, now))

    def arrivals(self, samples: Sequence[Any], now: int) -> tuple[tuple[int, Any], ...]:
        """As `deliver`, each sample with the time, ns, at which it comes."""
        for sample in samples:
            if sample.stamp > 0 and self._rng.random() < self.drop_out_rate:
                continue
            arrival = sample.stamp + (self.latency if sample.stamp > 0 else 0)
            last = self._waiting[-1][0] if self._waiting else 0
            self._waiting.append((max(arrival, last), sample))  # none overtakes another
        come = []
        while self._waiting and self._waiting[0][0] <= now:
            come.append(self._waiting.popleft())
        return tuple(come)
