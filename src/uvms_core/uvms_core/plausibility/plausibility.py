"""All topics of a vehicle against their bounds: what comes in with jumps, what goes out without."""

from collections.abc import Sequence
from typing import Any

from uvms_core import checks
from uvms_core.errors import ImplausibleError, SignalError
from uvms_core.plausibility.bounds import bounds_of
from uvms_core.plausibility.watch import Watch
from uvms_core.topic import Topic
from uvms_core.vehicle import Vehicle


class Plausibility:
    """Bounds of a vehicle, and the last samples of every topic that comes in."""

    def __init__(self, vehicle: Vehicle) -> None:
        self._vehicle = vehicle
        self._watches: dict[str, Watch] = {}

    def reset(self) -> None:
        """Forget all samples: time or place starts over."""
        for watch in self._watches.values():
            watch.reset()

    def admit(self, topic: Topic, signal: Any, is_checked: bool = False) -> str | None:
        """Take a sample that comes in; of one that is checked (`fault`) only its jump matters.

        Returns:
            What happened, in words, where a jump is taken for real; None as a rule.

        Raises:
            ImplausibleError: a value, or its jump from the last sample, is not possible.
        """
        watch = self._watches.get(topic.name) or self._watch(topic)
        fault = watch.fault(signal.stamp, signal, is_checked)
        if fault is not None:
            raise ImplausibleError(f"{topic.name}: {fault}")
        if watch.news is None:
            return None
        news, watch.news = watch.news, None
        return f"{topic.name}: {news}"

    def follows(self, topic: Topic, signal: Any) -> bool:
        """Take a signal that `fault` has just passed, if its jump is certainly possible.

        Quick; where it is False, `admit` decides.
        """
        watch = self._watches.get(topic.name)
        return watch is not None and watch.follows(signal)

    def are_good(self, topic: Topic, signals: Sequence[Any]) -> bool:
        """Take several samples in a row if all are certainly good; else none of them."""
        watch = self._watches.get(topic.name)
        return watch is not None and watch.are_good(signals)

    def fault(self, topic: Topic, signal: Any) -> str | None:
        """Why a signal must not go out, in words; None where it may, which marks it as checked."""
        watch = self._watches.get(topic.name) or self._watch(topic)
        if watch.rule.covers(type(signal)):
            values = checks.well_formed(signal)
            if values is not None and watch.is_possible(signal, values):  # and finite, all of it
                checks.trust(signal)
                return None
        return self._explain(topic, watch, signal)

    def _explain(self, topic: Topic, watch: Watch, signal: Any) -> str | None:
        """As `fault`, where the quick test of all values at once has left something open."""
        rule = watch.rule
        try:
            checks.check(topic.name, signal)
        except SignalError as fault:
            return str(fault)
        if not rule.bounds:
            return None
        if rule.is_flat:
            if watch.is_possible(signal, rule.values(signal)):
                return None
        elif rule.are_possible(signal):
            return None
        text = rule.explain(signal)
        return text and f"{topic.name}: {text}"

    def _watch(self, topic: Topic) -> Watch:
        watch = self._watches[topic.name] = Watch(bounds_of(self._vehicle, topic))
        return watch
