"""What a node gets and gives in a recorded run, tick by tick."""

from collections import Counter
from dataclasses import dataclass, field, replace

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_bringup.navigate.arrivals import Arrivals
from uvms_bringup.ros.recorder import stamp_of
from uvms_core import topics

Input = tuple[str, bytes]


@dataclass
class TickRecord:
    """One tick of a node: recorded inputs (full topic name, bytes), and how many outputs came."""

    stamp: int
    inputs: list[Input] = field(default_factory=list)
    outputs: Counter[str] = field(default_factory=Counter)


class TickOf:
    """The tick in which a node gives an output, from the output's stamp."""

    def __init__(self, run: RunLog, period: int, planner_step: int) -> None:
        self._period, self._step = period, planner_step
        self._reference = run.full_name(topics.REFERENCE)
        self._first = _first_stamp(run, self._reference)

    def __call__(self, name: str, stamp: int) -> int:
        """A reference comes one planner step ahead, but for the first, which begins at its tick; a
        sensor's samples since the last tick come with the tick at or after them.
        """
        if name == self._reference:
            return max(stamp - self._step, self._first)
        return -(-stamp // self._period) * self._period


def _first_stamp(run: RunLog, name: str) -> int:
    stamps = (stamp_of(data) for _, _, data in run.raw([name])) if name in run.topics else ()
    return next(iter(stamps), 0)


def with_gaps(run: RunLog, own: topics.NodeTopics) -> topics.NodeTopics:
    """The node's topics, with what the plant said of missing samples if it reads sensors, and what
    navigation said where it did not know the place, if it reads the odometry.
    """
    reads_sensors = any(topic is topics.JOINT_STATES or topic.sensor for topic in own.inputs)
    reads = {topics.SENSOR_GAPS: reads_sensors, topics.ODOMETRY_GAPS: topics.ODOMETRY in own.inputs}
    gaps = [topic for topic, is_read in reads.items() if is_read and run.has(topic)]
    return replace(own, inputs=(*own.inputs, *gaps))


def schedule(
    run: RunLog, node: str, tick_of: TickOf, wanted: topics.NodeTopics | None = None
) -> list[TickRecord]:
    """The ticks of a node, in order: those in which it gave something in the recorded run.

    Inputs belong to the first tick at or after their stamp. `wanted` are the node's topics with the
    vehicle of the run; None: those with the built-in sensors.

    Raises:
        LogError: the log lacks one of the node's inputs, or all of its outputs.
    """
    wanted = wanted or topics.NODES[node]
    there = [topic for topic in wanted.inputs if topic not in topics.COMPANIONS or run.has(topic)]
    inputs = [run.full_name(topic) for topic in there]
    outputs = [run.full_name(topic) for topic in wanted.outputs]
    lacking = [name for name in inputs if name not in run.topics]
    if lacking:
        raise LogError(f"log {run.path}: lacks inputs of {node}: {', '.join(lacking)}")
    ticks = _ticks(run, [name for name in outputs if name in run.topics], tick_of)
    if not ticks:
        raise LogError(f"log {run.path}: has no output of {node} ({', '.join(outputs)})")
    arrivals = Arrivals(run)

    def came(name: str, stamp: int) -> int:
        return arrivals(name, stamp, tick_of(name, stamp))

    recorded = sorted(
        ((came(name, stamp_of(data)), name, data) for name, _, data in run.raw(inputs)),
        key=lambda one: one[0],
    )
    order = iter(ticks)
    tick = next(order)
    for stamp, name, data in recorded:
        while stamp > tick.stamp:
            following = next(order, None)
            if following is None:
                return ticks
            tick = following
        tick.inputs.append((name, data))
    return ticks


def _ticks(run: RunLog, outputs: list[str], tick_of: TickOf) -> list[TickRecord]:
    ticks: dict[int, TickRecord] = {}
    for name, _, data in run.raw(outputs) if outputs else ():
        stamp = tick_of(name, stamp_of(data))
        ticks.setdefault(stamp, TickRecord(stamp)).outputs[name] += 1
    return [ticks[stamp] for stamp in sorted(ticks)]
