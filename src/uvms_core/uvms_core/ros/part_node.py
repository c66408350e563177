"""A node around a part of the loop: messages in, one call, messages out."""

import time
from abc import abstractmethod
from typing import Any

from uvms_core import diagnostics
from uvms_core.errors import UnsafeOutputError
from uvms_core.part import Part, safe_step
from uvms_core.ros.node import UvmsNode
from uvms_core.tick_gate import Tick
from uvms_core.timeline import Jump


class PartNode(UvmsNode):
    """Runs a part on the topics that it declares.

    Nothing that is not finite or not possible is ever published: where its output is such,
    the part is restarted and its safe output is published instead.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.part = self.make_part()
        self.step_ms = 0.0  # wall time of the last step
        self.unsafe_outputs = 0
        self._trouble: diagnostics.Trouble | None = None  # that was told last
        part = self.part
        self.connect(part.inputs, part.trigger, self.take_tick, part.in_loop, part.every)

    @abstractmethod
    def make_part(self) -> Part:
        """The part, from the vehicle and the node's parameters."""

    def take_tick(self, tick: Tick) -> None:
        """Step the part and publish; samples that it left out are reported."""
        began = time.perf_counter()
        outputs, fault = safe_step(self.role, self.part, tick, self.plausibility)
        silent = () if fault is None or self.lockstep else self.part.left_to_reader
        for topic, signal in outputs:
            if topic not in silent:
                self.send(topic, signal)
        self.step_ms = 1e3 * (time.perf_counter() - began)
        if isinstance(fault, UnsafeOutputError):
            self.unsafe_outputs += 1
            self.complain(tick.stamp, diagnostics.ERROR, str(fault))
        elif tick.missing:  # what was sent and not usable is counted already
            self.complain(tick.stamp, diagnostics.ERROR, str(fault))
        elif fault is not None:
            self.refuse(tick.stamp, [fault])
        self.refuse(tick.stamp, self.part.take_faults())
        self._tell(tick.stamp)

    def _tell(self, stamp: int) -> None:
        """How the part is, each second and whenever its trouble changes."""
        trouble = self.part.trouble()
        level, text = (diagnostics.OK, "ok") if trouble is None else trouble
        tell = self.report_each_second if trouble == self._trouble else self.report
        self._trouble = trouble
        tell(stamp, level, text, step_ms=self.step_ms, **self.part.status())

    def on_time_jump(self, jump: Jump) -> None:
        """Time has jumped: the part is restarted."""
        self.part.restart(str(jump))

    def more_counts(self) -> dict[str, int]:
        """Ticks at which the output of the part was invalid."""
        return {"unsafe_outputs": self.unsafe_outputs}
