"""When the samples in the log of a run reached its nodes."""

from uvms_analysis.log.read import RunLog
from uvms_core import topics


class Arrivals:
    """When samples came: with their stamps, or later where the plant said so."""

    def __init__(self, run: RunLog) -> None:
        self._told: dict[str, dict[int, int]] = {}  # newest stamp by tick, by full topic name
        gaps = run.signals(topics.SENSOR_GAPS) if run.has(topics.SENSOR_GAPS) else []
        sampled = topics.sampled_topics(run.vehicle) if gaps else {}
        for each in gaps:
            for sensor, newest in zip(each.sensors, each.newest, strict=True):
                name = sampled[sensor].resolve(run.namespace)
                self._told.setdefault(name, {})[each.stamp] = newest

    def __call__(self, name: str, stamp: int, tick: int) -> int:
        """The stamp or tick with which a sample came that was due at `tick`, ns."""
        told = self._told.get(name, {})
        if told.get(tick, stamp) >= stamp:
            return stamp
        return min(
            (at for at, newest in told.items() if at > tick and newest >= stamp), default=stamp
        )
