"""Node `navigation`: the extended Kalman filter on the sensors' topics."""

from pathlib import Path
from typing import Any

from pydantic import Field

from uvms_core import topics
from uvms_core.config import Config
from uvms_core.diagnostics import ERROR
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode
from uvms_core.tick_gate import Tick
from uvms_observer import NavigationConfig
from uvms_observer.nodes.checkpoint import Checkpoint
from uvms_observer.parts import NavigationPart, navigation_part
from uvms_observer.truth import TruthPart


class CheckpointConfig(Config):
    """Where the node keeps its estimate."""

    checkpoint_file: str = Field(
        "",
        description="file to which the node writes its estimate once a second, and from which it"
        " goes on when it is started again in the same run; empty: none",
    )


class NavigationNode(PartNode):
    """sensors/* in, odometry out, once a control tick; the truth in, where that is the source."""

    role = topics.NAVIGATION
    configurations = (NavigationConfig, CheckpointConfig)
    part: NavigationPart | TruthPart

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.offer(topics.ODOMETRY_GAPS)

    def make_part(self) -> NavigationPart | TruthPart:
        """The navigation filter that the parameters name, or the truth."""
        part = navigation_part(self.vehicle, self.config(NavigationConfig), self.period)
        file = self.config(CheckpointConfig).checkpoint_file
        kept = file and isinstance(part, NavigationPart)  # the truth needs no memory
        self._checkpoint = Checkpoint(Path(file), self.run_id) if kept else None
        estimate = self._checkpoint.read() if self._checkpoint else None
        if estimate is not None and isinstance(part, NavigationPart):
            part.remember(estimate)
        return part

    def take_tick(self, tick: Tick) -> None:
        """One step of the filter; its estimate is kept for a start after this one."""
        super().take_tick(tick)
        estimate = self.part.estimate
        trouble = self.part.trouble()
        is_lost = trouble is not None and trouble.level == ERROR
        if self._checkpoint is None or estimate is None or is_lost:
            return
        try:
            self._checkpoint.write(estimate)
        except OSError as fault:
            text = f"checkpoint_file {fault.filename}: {fault.strerror}"
            self.get_logger().warning(text, throttle_duration_sec=60.0)


def main(args=None) -> int:
    """`ros2 run uvms_observer navigation`."""
    return main_of(NavigationNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
