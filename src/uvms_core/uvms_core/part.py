"""A part of the control loop, free of ROS: the same object runs in a node and in the process.

A part declares once what it takes for a tick and what it gives. Its node subscribes, publishes and
waits by that declaration, and the in-process loop calls the parts in the order that follows from
it, so that both compute the same.
"""

import traceback
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from itertools import groupby
from typing import Any

import numpy as np

from uvms_core import topics
from uvms_core.diagnostics import ERROR, OK, Status, Trouble
from uvms_core.errors import (
    PlantDiverged,
    PluginError,
    SignalError,
    StaleError,
    UnsafeOutputError,
    UvmsError,
)
from uvms_core.plausibility import Plausibility
from uvms_core.signals import to_seconds
from uvms_core.tick_gate import Input, Previous, Tick
from uvms_core.topics import Topic

Output = tuple[Topic, Any]
"""A topic and the signal that goes out on it."""


def _name(output: Output) -> str:
    return output[0].name


class Part(ABC):
    """One part of the loop.

    Attributes:
        inputs: how each topic that it reads belongs to a tick.
        outputs: topics that it publishes.
        trigger: the input whose stamps are the ticks.
        every: only stamps at multiples of this are ticks, ns.
        in_loop: whether the plant waits for its answer (see `TickGate`).
        left_to_reader: safe outputs that its node does not publish in real time: whoever reads
            them holds the last one for a while and then goes to a better safe state of its own.
    """

    inputs: Mapping[Topic, Input]
    outputs: Sequence[Topic]
    trigger: Topic
    every: int = 1
    in_loop: bool = True
    left_to_reader: Sequence[Topic] = ()

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

    def withheld(self) -> Sequence[Topic]:
        """Outputs that the last step left out on purpose, so that nobody waits for them."""
        return ()

    def trouble(self) -> Trouble | None:
        """Why what it puts out cannot be relied on, for /diagnostics; None where it can."""
        return None

    def restart(self, reason: str) -> None:
        """Start over with the same configuration: its state is no longer valid.

        Args:
            reason: in words, for whoever waits for this part.
        """
        return None

    def safe(self, tick: Tick) -> Iterable[Output]:
        """What to put out at a tick at which the part cannot step, or its output is invalid.

        Nothing, by default: whoever reads its outputs then goes to its own safe state.
        """
        return ()


class InProcess:
    """Hands signals to parts and calls them, without ROS and without waiting.

    What overflows is refused; a caller that wants no warnings of numpy about it puts
    `np.errstate(all="ignore")` around its ticks, as nodes do.

    Args:
        parts: by role; they are called in the order in which their inputs come to be.
        plausibility: of what comes from outside and of what the parts put out; None: no checks.
    """

    def __init__(self, parts: Mapping[str, Part], plausibility: Plausibility | None = None) -> None:
        self.order = loop_order(parts)
        self._plausibility = plausibility
        self._parts = [
            (role, part, [(topic.name, rule) for topic, rule in part.inputs.items()])
            for role, part in ((role, parts[role]) for role in self.order)
        ]
        self._rules: dict[str, list[Input]] = {}
        for part in parts.values():
            for topic, rule in part.inputs.items():
                self._rules.setdefault(topic.name, []).append(rule)
        self._faults: list[str] = []
        self._readers: dict[str, list[str]] = {
            name: [role for role in self.order if name in {t.name for t in parts[role].inputs}]
            for name in self._rules
        }
        self._counts: dict[str, dict[str, int]] = {
            role: {"refused": 0, "unsafe_outputs": 0} for role in self.order
        }
        self._excuses = False
        self._troubles: dict[str, Trouble | None] = {}  # what was told last
        self.refused = 0
        """Signals from outside that were not used."""

    @property
    def unsafe(self) -> int:
        """Ticks at which the output of a part was invalid and its safe output was used instead."""
        return sum(counts["unsafe_outputs"] for counts in self._counts.values())

    def final_status(self, stamp: int) -> Iterator[Status]:
        """What each part has counted, as its node would say it at the end of a run."""
        for role, part, _ in self._parts:
            yield _status(stamp, role, part.trouble(), {**self._counts[role], **part.status()})

    def admit_all(self, outputs: Iterable[Output]) -> None:
        """Hand over signals from outside, as `admit` does."""
        for name, group in groupby(outputs, key=_name):
            if name not in self._rules:
                continue
            kinds, signals = zip(*group, strict=True)
            take = self.deliver if self._are_good(kinds[0], signals) else self.admit
            for signal in signals:
                take(kinds[0], signal)

    def _are_good(self, topic: Topic, signals: Sequence[Any]) -> bool:
        if self._plausibility is None:
            return True
        return len(signals) > 1 and self._plausibility.are_good(topic, signals)

    def admit(self, topic: Topic, signal: Any) -> None:
        """Hand over a signal from outside; one that this vehicle cannot have is excused."""
        if topic.name not in self._rules:
            return
        if self._is_refused(topic, signal):
            self._excuse(topic, signal.stamp)
        else:
            self.deliver(topic, signal)

    def is_usable(self, topic: Topic, signal: Any) -> bool:
        """Whether who reads a part's output outside, as the plant does, may use it."""
        plausibility = self._plausibility
        if plausibility is None or plausibility.follows(topic, signal):
            return True
        return not self._is_refused(topic, signal, is_checked=True)

    def _is_refused(self, topic: Topic, signal: Any, is_checked: bool = False) -> bool:
        if self._plausibility is None:
            return False
        try:
            self._plausibility.admit(topic, signal, is_checked)
        except UvmsError as fault:
            self.refused += 1
            self._refuse(self._readers.get(topic.name, ()), fault)
            return True
        return False

    def _refuse(self, roles: Iterable[str], fault: UvmsError) -> None:
        self._faults.append(str(fault))
        for role in roles:
            self._counts[role]["refused"] += 1

    def deliver(self, topic: Topic, signal: Any) -> None:
        """Hand a signal to every part that reads its topic."""
        for rule in self._rules.get(topic.name, ()):
            rule.push(signal.stamp, signal)

    def _excuse(self, topic: Topic, stamp: int) -> None:
        self._excuses = True
        for rule in self._rules.get(topic.name, ()):
            rule.excuse(stamp)

    def tick(self, stamp: int) -> Iterator[tuple[str, list[Output]]]:
        """Call each part whose tick this stamp is; yields role and outputs, already delivered.

        What was refused, parts whose output was invalid, and a part's trouble where it has changed,
        are among the outputs as diagnostics.
        """
        for role, part, rules in self._parts:
            if stamp % part.every:
                continue
            missing = self._missing(rules, stamp) if self._excuses else ()
            tick = Tick(stamp, {name: rule.take(stamp) for name, rule in rules}, missing)
            outputs = self._step(role, part, tick)
            for topic, signal in outputs:
                self._pass_on(topic, signal)
            for topic in part.withheld():
                self._excuse(topic, stamp)
            if self._faults:
                outputs.append(self._diagnosis(role, stamp))
            if (trouble := part.trouble()) != self._troubles.get(role):
                self._troubles[role] = trouble
                values = {**self._counts[role], **part.status()}
                outputs.append((topics.DIAGNOSTICS, _status(stamp, role, trouble, values)))
            yield role, outputs

    def _pass_on(self, topic: Topic, signal: Any) -> None:
        """Hand a part's output to its readers, which look at jumps as nodes do."""
        rules = self._rules.get(topic.name)
        if rules is None:
            return
        if not self.is_usable(topic, signal):
            self._excuse(topic, signal.stamp)
            return
        for rule in rules:
            rule.push(signal.stamp, signal)

    @staticmethod
    def _missing(rules: Iterable[tuple[str, Input]], stamp: int) -> tuple[str, ...]:
        return tuple(name for name, rule in rules if rule.missing(stamp))

    def _step(self, role: str, part: Part, tick: Tick) -> list[Output]:
        if self._plausibility is None:
            return run_step(role, part, tick)
        outputs, fault = safe_step(role, part, tick, self._plausibility)
        if isinstance(fault, UnsafeOutputError):
            self._counts[role]["unsafe_outputs"] += 1
            self._faults.append(str(fault))
        elif fault is not None and (tick.missing or isinstance(fault, StaleError)):
            self._faults.append(str(fault))
        elif fault is not None:
            raise fault
        for sample in part.take_faults():
            self._refuse([role], sample)
        return outputs

    def _diagnosis(self, role: str, stamp: int) -> Output:
        text, self._faults = "; ".join(self._faults), []
        return topics.DIAGNOSTICS, Status(stamp, role, ERROR, text, dict(self._counts[role]))


def _status(
    stamp: int, role: str, trouble: Trouble | None, values: Mapping[str, float | int | bool | str]
) -> Status:
    level, text = (OK, "ok") if trouble is None else trouble
    return Status(stamp, role, level, text, values)


def safe_step(
    role: str, part: Part, tick: Tick, plausibility: Plausibility
) -> tuple[list[Output], UvmsError | None]:
    """As `run_step`, but nothing that is not finite or not possible gets out.

    A part whose output is invalid is restarted, since its state may be the cause, and its safe
    output takes the place of the invalid one.

    Returns:
        The outputs, and why they are the safe ones where they are: `UnsafeOutputError`, or the
        error of an input that cannot be used (the part keeps its state then).

    Raises:
        PluginError: the step fails in any other way.
    """
    try:
        if tick.missing:
            raise SignalError(f"no usable {' and no '.join(tick.missing)}")
        outputs = run_step(role, part, tick)
    except (PlantDiverged, PluginError):
        raise
    except UnsafeOutputError as fault:
        return _fall_back(part, tick, plausibility, fault), fault
    except UvmsError as fault:
        return _possible(part.safe(tick), plausibility), fault
    for topic, signal in outputs:
        if text := plausibility.fault(topic, signal):
            unsafe = UnsafeOutputError(
                f"{role}: output is not finite or beyond its bounds; restarted: {text}"
            )
            return _fall_back(part, tick, plausibility, unsafe), unsafe
    return outputs, None


def _fall_back(
    part: Part, tick: Tick, plausibility: Plausibility, fault: UvmsError
) -> list[Output]:
    part.restart(str(fault))
    return _possible(part.safe(tick), plausibility)


def _possible(outputs: Iterable[Output], plausibility: Plausibility) -> list[Output]:
    """Those that may go out."""
    return [output for output in outputs if plausibility.fault(*output) is None]


def run_step(role: str, part: Part, tick: Tick) -> list[Output]:
    """The outputs of a part's tick.

    Raises:
        UvmsError: an input cannot be used; the part keeps its last good state.
        UnsafeOutputError: its numbers overflow or cannot be solved for.
        PluginError: its step fails in any other way: what it is made of has a mistake.
    """
    try:
        return list(part.step(tick))
    except UvmsError:
        raise
    except (np.linalg.LinAlgError, OverflowError, FloatingPointError) as fault:  # invalid numbers
        raise UnsafeOutputError(
            f"{role}: output cannot be computed; restarted: {type(fault).__name__}: {fault}"
        ) from fault
    except (Exception, SystemExit) as fault:  # a class of the user's may raise anything
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
