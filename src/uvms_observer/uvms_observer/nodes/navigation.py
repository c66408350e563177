"""Node `navigation`: the extended Kalman filter on the sensors' topics."""

from pathlib import Path
from typing import Any

from pydantic import Field
from std_srvs.srv import Trigger

from uvms_core import topics
from uvms_core.config import Config
from uvms_core.diagnostics import ERROR
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode
from uvms_core.signals import Odometry
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
    """sensors/* and allocation in, odometry out, once a tick; or the truth in, if so configured."""

    role = topics.NAVIGATION
    configurations = (NavigationConfig, CheckpointConfig)
    part: NavigationPart | TruthPart

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self.offer(topics.ODOMETRY_GAPS)
        self.create_service(Trigger, f"{self.get_name()}/reset", self._answer_reset)

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
        self._keep(estimate)

    def _keep(self, estimate: Odometry | None) -> None:
        """Write the estimate to the checkpoint, or remove what is there."""
        if self._checkpoint is None:
            return
        try:
            if estimate is None:
                self._checkpoint.forget()
            else:
                self._checkpoint.write(estimate)
        except OSError as fault:
            text = f"checkpoint_file {fault.filename}: {fault.strerror}"
            self.get_logger().warning(text, throttle_duration_sec=60.0)

    def _answer_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Start the filter anew, loudly."""
        if not isinstance(self.part, NavigationPart):
            response.success = False
            response.message = "navigation has the truth for its source, which nobody resets"
            return response
        response.success, response.message = True, self.part.reset()
        self._keep(None)
        now = 0 if self.part.last is None else self.part.last.stamp
        self.get_logger().error(response.message)
        self.report(now, ERROR, response.message)
        return response


def main(args=None) -> int:
    """`ros2 run uvms_observer navigation`."""
    return main_of(NavigationNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
