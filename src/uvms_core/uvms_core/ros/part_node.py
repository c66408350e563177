"""A node around a part of the loop: messages in, one call, messages out."""

import time
from abc import abstractmethod
from typing import Any

from uvms_core.part import Part, run_step
from uvms_core.ros.node import UvmsNode
from uvms_core.tick_gate import Tick


class PartNode(UvmsNode):
    """Runs a part on the topics that it declares."""

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.part = self.make_part()
        self.step_ms = 0.0  # wall time of the last step
        part = self.part
        self.connect(part.inputs, part.trigger, self.take_tick, part.in_loop, part.every)

    @abstractmethod
    def make_part(self) -> Part:
        """The part, from the vehicle and the node's parameters."""

    def take_tick(self, tick: Tick) -> None:
        """Step the part and publish; samples that it left out are reported."""
        began = time.perf_counter()
        for topic, signal in run_step(self.role, self.part, tick):
            self.send(topic, signal)
        self.step_ms = 1e3 * (time.perf_counter() - began)
        self.refuse(tick.stamp, self.part.take_faults())
        self.report_each_second(tick.stamp, step_ms=self.step_ms, **self.part.status())
