"""A part of the control loop, free of ROS: the same object runs in a node and in the process.

A part declares once what it takes for a tick and what it gives. Its node subscribes, publishes and
waits by that declaration, and the in-process loop calls the parts in the order that follows from
it, so that both compute the same.
"""

import traceback
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from typing import Any

from uvms_core.errors import PluginError, UvmsError
from uvms_core.signals import to_seconds
from uvms_core.tick_gate import Input, Previous, Tick
from uvms_core.topics import Topic

Output = tuple[Topic, Any]
"""A topic and the signal that goes out on it."""


class Part(ABC):
    """One part of the loop.

    Attributes:
        inputs: how each topic that it reads belongs to a tick.
        outputs: topics that it publishes.
        trigger: the input whose stamps are the ticks.
        every: only stamps at multiples of this are ticks, ns.
        in_loop: whether the plant waits for its answer (see `TickGate`).
    """

    inputs: Mapping[Topic, Input]
    outputs: Sequence[Topic]
    trigger: Topic
    every: int = 1
    in_loop: bool = True

    @abstractmethod
    def step(self, tick: Tick) -> Iterable[Output]:
        """The outputs of a tick, in the order of publication.

        Raises:
            UvmsError: an input cannot be used; the part keeps its last good state.
        """

    def take_faults(self) -> Sequence[UvmsError]:
        """Samples of the last tick that were not used, and why; each is handed out once."""
        return ()

    def status(self) -> Mapping[str, float | int | bool | str]:
        """Values for /diagnostics."""
        return {}


class InProcess:
    """Hands signals to parts and calls them, without ROS and without waiting.

    Args:
        parts: by role; they are called in the order in which their inputs come to be.
    """

    def __init__(self, parts: Mapping[str, Part]) -> None:
        self.order = loop_order(parts)
        self._parts = [
            (role, part, [(topic.name, rule) for topic, rule in part.inputs.items()])
            for role, part in ((role, parts[role]) for role in self.order)
        ]
        self._rules: dict[str, list[Input]] = {}
        for part in parts.values():
            for topic, rule in part.inputs.items():
                self._rules.setdefault(topic.name, []).append(rule)

    def deliver(self, topic: Topic, signal: Any) -> None:
        """Hand a signal to every part that reads its topic."""
        for rule in self._rules.get(topic.name, ()):
            rule.push(signal.stamp, signal)

    def tick(self, stamp: int) -> Iterator[tuple[str, list[Output]]]:
        """Call each part whose tick this stamp is; yields role and outputs, already delivered."""
        for role, part, rules in self._parts:
            if stamp % part.every:
                continue
            inputs = {name: rule.take(stamp) for name, rule in rules}
            outputs = run_step(role, part, Tick(stamp, inputs))
            for topic, signal in outputs:
                self.deliver(topic, signal)
            yield role, outputs


def run_step(role: str, part: Part, tick: Tick) -> list[Output]:
    """The outputs of a part's tick.

    Raises:
        UvmsError: an input cannot be used; the part keeps its last good state.
        PluginError: its step fails in any other way: what it is made of has a mistake.
    """
    try:
        return list(part.step(tick))
    except UvmsError:
        raise
    except Exception as fault:  # a class of the user's may raise anything
        where = traceback.extract_tb(fault.__traceback__)[-1]
        raise PluginError(
            f"{role}: its step failed at t = {to_seconds(tick.stamp):g} s:"
            f" {type(fault).__name__}: {fault} ({where.filename}:{where.lineno})"
        ) from fault


def loop_order(parts: Mapping[str, Part]) -> tuple[str, ...]:
    """Roles such that each part comes after those that give its inputs of the same tick.

    Raises:
        PluginError: parts wait for each other within a tick; names them.
    """
    writers = {topic.name: role for role, part in parts.items() for topic in part.outputs}
    sorter = TopologicalSorter(
        {
            role: [
                writers[topic.name]
                for topic, rule in part.inputs.items()
                if topic.name in writers and not isinstance(rule, Previous)
            ]
            for role, part in parts.items()
        }
    )
    try:
        return tuple(sorter.static_order())
    except CycleError as fault:
        ring = " -> ".join(fault.args[1])
        raise PluginError(f"parts of the loop wait for each other within a tick: {ring}") from fault
