"""How many messages a topic must have, from the vehicle file, the scenario and the span."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from uvms_analysis.check.contents import Contents
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.sensors import mounted_sensors
from uvms_core.signals import to_nanoseconds
from uvms_core.topic import Topic

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

    Raises:
        LogError: it does, but its configuration has no usable periods.
    """
    log = contents.log
    try:
        config, vehicle = log.configuration(), log.vehicle
    except LogError:  # a finding of its own: `check.end`
        return None
    tick, step = _period(config, "plant.control_period_s"), _period(config, "planner.step_s")
    found = {each: Rhythm(tick) for each in topics.of(vehicle) if not each.is_occasional}
    for sensor in mounted_sensors(vehicle):
        found[sensor.topic] = Rhythm(to_nanoseconds(1.0 / sensor.section.rate_hz))
    if vehicle.battery is not None:
        found[topics.BATTERY_STATE] = Rhythm(to_nanoseconds(topics.BATTERY_PERIOD_S))
    # At the first step the planner plans two steps ahead, at each of the others one.
    found[topics.REFERENCE] = Rhythm(step, extra=1)
    found |= {topic: Rhythm(0, extra=1) for topic in LATCHED}
    found.pop(topics.DIAGNOSTICS)  # a node reports when it has something to say
    for topic in _with_gaps(log, contents.is_lockstep):
        found.pop(topic, None)
    return Rhythms(tick, {log.full_name(topic): rhythm for topic, rhythm in found.items()})


def _with_gaps(log: RunLog, is_lockstep: bool) -> Iterator[Topic]:
    """Topics that did not all come when they were due, as somebody says.

    Samples of sensors, of which the plant says so; the odometry, and what follows from it, where
    navigation does not know yet where the vehicle is: in real time the torques as well, which the
    controller then leaves to the brakes. What was sent and not recorded is found out all the same.
    """
    told = [topic for topic in topics.GAPS if log.has(topic)]
    names = {name for topic in told for each in log.signals(topic) for name in each.sensors}
    for name, topic in topics.sampled_topics(log.vehicle).items():
        if name in names:
            yield topic
    if topics.ODOMETRY.name in names:
        yield from (topics.TF, topics.REFERENCE, topics.STABILITY)
        if not is_lockstep:
            yield topics.JOINT_COMMAND


def _period(config: Mapping[str, Any], path: str) -> int:
    """A period of the configuration in ns."""
    section, name = path.split(".")
    try:
        period = to_nanoseconds(float(config[section][name]))
    except (KeyError, TypeError, ValueError, OverflowError):
        period = 0
    if period <= 0:
        raise LogError(f"its attachment 'config.yaml' has no usable {path}")
    return period
