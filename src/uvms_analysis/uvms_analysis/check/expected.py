"""How many messages a topic must have, from the vehicle file, the scenario and the span."""

from dataclasses import dataclass

from uvms_analysis.check.contents import Contents
from uvms_analysis.errors import LogError
from uvms_core import topics
from uvms_core.errors import UvmsError
from uvms_core.sensors import sensor_types
from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle.loader import vehicle_from_yaml

LATCHED = (topics.TF_STATIC, topics.ROBOT_DESCRIPTION)


@dataclass(frozen=True)
class Rhythm:
    """A topic with a message at every multiple of its period from 0 on, and some more."""

    period: int  # ns; 0: `extra` messages in all
    extra: int = 0

    def count(self, span: int) -> int:
        """Messages within a span in ns that begins at 0."""
        return self.extra if not self.period else span // self.period + 1 + self.extra


@dataclass(frozen=True)
class Rhythms:
    """The rhythms of a run by full topic name, and its control period in ns."""

    period: int
    topics: dict[str, Rhythm]


def rhythms(contents: Contents) -> Rhythms | None:
    """The rhythms of the run; None where the log does not say what was run.

    A damaged configuration is a finding of its own: `check.end`.
    """
    log = contents.log
    try:
        config = log.configuration()
        vehicle = vehicle_from_yaml(log.text("vehicle.yaml"), "vehicle.yaml")
        tick = to_nanoseconds(float(config["plant"]["control_period_s"]))
        step = to_nanoseconds(float(config["planner"]["step_s"]))
        if tick <= 0 or step <= 0:
            return None
    except (UvmsError, LogError, KeyError, TypeError, ValueError, OverflowError):
        return None
    found = {topic: Rhythm(tick) for topic in topics.of(vehicle)}
    for sensor in sensor_types(vehicle):
        rate = vehicle.sensors.mounted[sensor.name].rate_hz
        found[sensor.topic] = Rhythm(to_nanoseconds(1.0 / rate))
    # At the first step the planner plans two steps ahead, at each of the others one.
    found[topics.REFERENCE] = Rhythm(step, extra=1)
    found |= {topic: Rhythm(0, extra=1) for topic in LATCHED}
    found.pop(topics.DIAGNOSTICS)  # a node reports when it has something to say
    return Rhythms(tick, {log.full_name(topic): rhythm for topic, rhythm in found.items()})
