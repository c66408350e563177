"""Node `plant`: vehicle, arm, water and sensors; it owns time and publishes /clock."""

import time
from collections.abc import Sequence
from functools import partial
from typing import Any

from pydantic import Field
from std_srvs.srv import SetBool, Trigger

from uvms_core import diagnostics, topics
from uvms_core.attitude import attitude_status
from uvms_core.battery import battery_status
from uvms_core.checks import MAX_AGE_S
from uvms_core.config import Config
from uvms_core.errors import ConfigError, StampError
from uvms_core.ros.endpoints import Endpoint, Publishers
from uvms_core.ros.main import main_of
from uvms_core.ros.node import DIAGNOSTICS_PERIOD, UvmsNode
from uvms_core.ros.roll_call import SEPARATOR, RollCall, unread
from uvms_core.signals import (
    Array,
    JointCommand,
    ThrusterCommand,
    to_nanoseconds,
    to_seconds,
)
from uvms_core.timeline import tolerance
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.events import EventsConfig, event_from_text, status_values
from uvms_dynamics.simulation.publication import plant_outputs
from uvms_dynamics.simulation.sensors.suite import in_order_of_publication
from uvms_msgs.srv import ApplyEvent

COMMANDS = (topics.THRUSTER_COMMAND.name, topics.JOINT_COMMAND.name)
POLL = 0.05
"""How often an idle plant checks whether all its peers are there, s of wall time."""
NOTICE = 10.0
"""How often it logs what is still missing, s of wall time."""
SETTLE = 1.0
"""How long all must have been there before the start, s of wall time."""
LOOK = 1.0
"""How often a running plant looks for others that publish its topics, s of wall time."""


class PaceConfig(Config):
    """How the plant's time runs."""

    realtime_factor: float = Field(
        1.0, gt=0.0, le=1000.0, description="simulated seconds a wall second, at pace realtime"
    )
    timeout_s: float = Field(
        20.0, gt=0.0, description="wall time that lockstep waits for a command, s"
    )
    first_timeout_s: float = Field(
        180.0, gt=0.0, description="the same at the first tick, when nodes may still compile, s"
    )
    stale_s: float = Field(
        MAX_AGE_S, gt=0.0, description="age at which realtime takes a command for missing, s"
    )
    duration_s: float = Field(0.0, ge=0.0, description="where the plant stops, s; 0: never")
    auto_start: bool = Field(True, description="start by itself as soon as all nodes are there")
    start_paused: bool = Field(False, description="close the loop at t = 0, then wait in pause")
    recorder_window: int = Field(
        0,
        ge=0,
        description="control periods that lockstep may be ahead of what a recorder says on"
        " `recorded`; 0: it waits for none",
    )


class PlantNode(UvmsNode):
    """thruster_command, joint_command in; sensors, joint_states, battery_state, truth, /clock out.

    Services: `start` (begin, where `auto_start` is false), `pause` (hold simulated time),
    `apply_event` (something happens to the vehicle) and `reset` (back to the start, at t = 0).
    """

    role = topics.PLANT
    configurations = (PaceConfig, PlantConfig, EventsConfig)

    def __init__(self, **options) -> None:
        super().__init__(**options)
        self.offer(topics.SENSOR_GAPS)
        self._plant = self._make_plant()
        self._pace = self.config(PaceConfig)
        self._end = to_nanoseconds(self._pace.duration_s) or None
        self._commands: dict[str, Any] = {}
        self._without: set[str] = set()  # commands of this tick that came but cannot be used
        self._running = False
        self._paused = self._pace.start_paused
        self._pauses = 0
        self._wanted = self._pace.auto_start
        self._deadline: float | None = time.monotonic() + POLL
        self._timeouts = 0
        self._complete_since: float | None = None
        others = [name for name in self.graph if name != self.role]
        self._roll_call = RollCall(self, others, foreign=None, graph=self.graph)
        self._sensor_topics = in_order_of_publication(self.vehicle)
        self._notice = time.monotonic() + NOTICE
        self._rivals = Publishers(self, {topic.name: 1 for topic in self.graph[self.role].outputs})
        self._rivals.know()
        self._look = time.monotonic() + LOOK
        self._recorded, self._held = 0, False
        self._warned = -DIAGNOSTICS_PERIOD
        if self.lockstep and self._pace.recorder_window:
            self.listen(topics.RECORDED, self._take_recorded)
        for topic in (topics.THRUSTER_COMMAND, topics.JOINT_COMMAND):
            name = topic.name
            self.listen(topic, partial(self._take, name), partial(self._take_refused, name))
        self.create_service(Trigger, "start", self._answer_start)
        self.create_service(SetBool, "pause", self._answer_pause)
        self.create_service(Trigger, "reset", self._answer_reset)
        self.create_service(ApplyEvent, "apply_event", self._answer_event)

    def _make_plant(self) -> Plant:
        """The plant at its start, with the events of the parameters before it."""
        events = self.config(EventsConfig).events
        return Plant(self.vehicle, self.config(PlantConfig), self.seed, events)

    def deadline(self) -> float | None:
        """When the plant is to be woken, monotonic wall time in s."""
        return self._deadline

    def on_wake(self) -> None:
        """The deadline passed: check for peers, or continue without the missing commands."""
        if not self._running:
            self._deadline = time.monotonic() + POLL
            if self._wanted:
                self._start_when_settled()
        elif self._held:
            self._say_held()
        elif self.lockstep:
            self._time_out()
        else:
            self._advance()

    def _start_when_settled(self) -> None:
        if not self._all_there():
            self._complete_since = None
        elif self._complete_since is None:
            self._complete_since = time.monotonic()
        elif time.monotonic() - self._complete_since > SETTLE:
            self.get_logger().info("all nodes are there: starting")
            self._start()

    def _all_there(self) -> bool:
        lacks = self._roll_call.poll()
        idle = unread(self._roll_call.foreign, self.graph)
        if own := [lack for lack in self.missing_peers() if lack not in idle]:
            lacks[self.role] = SEPARATOR.join(own)
        if rivals := self._rivals.strangers():
            lacks[self.role] = _rivals_text(rivals)
            self.report(0, diagnostics.ERROR, lacks[self.role])
        if lacks and time.monotonic() > self._notice:
            self._notice = time.monotonic() + NOTICE
            missing = "\n".join(f"  {role}: {lack}" for role, lack in lacks.items())
            self.get_logger().info(f"waiting for\n{missing}")
        return not lacks

    def _start(self) -> None:
        self._running = True
        self._rivals.know()
        self._publish_tick()
        self._deadline = time.monotonic()
        self._deadline = self._next_deadline(self._pace.first_timeout_s)

    def _take(self, name: str, command: ThrusterCommand | JointCommand) -> None:
        newest = self._commands.get(name)
        if command.stamp > self._plant.stamp:
            raise StampError(
                f"{name}: its stamp, {to_seconds(command.stamp):.3f} s, is ahead of the plant's"
                f" time, {to_seconds(self._plant.stamp):.3f} s"
            )
        if newest is not None and command.stamp <= newest.stamp:
            raise StampError(
                f"{name}: its stamp, {to_seconds(command.stamp):.3f} s, is not after that of the"
                f" last command, {to_seconds(newest.stamp):.3f} s"
            )
        self._commands[name] = command
        if self.lockstep and self._complete():
            self._advance()

    def _take_refused(self, name: str, stamp: int | None) -> None:
        """A command for this tick that cannot be used: nothing better will come to wait for."""
        if stamp == self._plant.stamp:
            self._without.add(name)
            if self.lockstep and self._complete():
                self._advance()

    def _complete(self) -> bool:
        """Whether every command for the present stamp has come, for better or worse."""
        return all(name in self._without or self._is_new(name) for name in COMMANDS)

    def _is_new(self, name: str) -> bool:
        command = self._commands.get(name)
        return command is not None and command.stamp == self._plant.stamp

    def _advance(self) -> None:
        if not self._running or self._paused or self._finished:
            self._deadline = None if self.lockstep else time.monotonic() + POLL
            return
        if not self.lockstep:
            self._warn_of_stale()
        elif self._ahead_of_recorder():
            return
        self._plant.step(*map(self._usable, COMMANDS))
        self._without.clear()
        self._publish_tick()
        self._deadline = self._next_deadline(self._pace.timeout_s)
        self._look_for_rivals()

    def _ahead_of_recorder(self) -> bool:
        """Whether the plant has to wait; it then goes on with the commands that it has."""
        window = self._pace.recorder_window * self.period
        self._held = window > 0 and self._plant.stamp - self._recorded >= window
        if self._held:
            self._deadline = time.monotonic() + self._pace.timeout_s
        return self._held

    def _take_recorded(self, stamp: int) -> None:
        self._recorded = max(self._recorded, stamp)
        if self._held:
            self._held = False
            self._advance()

    def _say_held(self) -> None:
        """Nothing is lost while it waits, so it waits without end, and says so."""
        self._deadline = time.monotonic() + self._pace.timeout_s
        text = (
            f"t = {to_seconds(self._plant.stamp):.2f} s: waiting for the recorder, which has "
            f"recorded up to t = {to_seconds(self._recorded):.2f} s"
        )
        self.get_logger().warning(text)
        self.report(self._plant.stamp, diagnostics.WARN, text, lockstep_timeouts=self._timeouts)

    def _look_for_rivals(self) -> None:
        now = time.monotonic()
        if now < self._look:
            return
        self._look = now + LOOK
        if rivals := self._rivals.strangers():
            text = _rivals_text(rivals)
            self.get_logger().error(text, throttle_duration_sec=NOTICE)
            self.report(self._plant.stamp, diagnostics.ERROR, text)

    def more_counts(self) -> dict[str, int]:
        """How often time was held, whoever asked for it."""
        return {**super().more_counts(), diagnostics.PAUSES: self._pauses}

    def _publish_tick(self) -> None:
        stamp, sensors, truth = self._plant.stamp, self._plant.sense(), self._plant.truth()
        for topic, signal in plant_outputs(stamp, sensors, truth, self._sensor_topics):
            self.send(topic, signal)
        self._say_what_happened()
        self._warn(stamp, truth.odometry.quaternion)
        self.report_each_second(stamp, **self._values)

    def _say_what_happened(self) -> None:
        happened = self._plant.take_happened()
        for event in happened:
            self.get_logger().info(f"t = {to_seconds(event.stamp):g} s: {event.text}")
        if happened:
            self.report(self._plant.stamp, **self._values, **status_values(happened))

    def _warn(self, stamp: int, quaternion: Array) -> None:
        """Of attitude and battery, at most once a second, whatever else there is to report."""
        if 0 <= stamp - self._warned < DIAGNOSTICS_PERIOD:
            return
        battery = battery_status(self._plant.battery_share)
        level, text = diagnostics.together(attitude_status(quaternion), battery)
        if level != diagnostics.OK:
            self._warned = stamp
            self.report(stamp, level, text, **self._values)

    @property
    def _values(self) -> dict[str, Any]:
        """What the plant says about its time, besides what all nodes count."""
        return {"lockstep_timeouts": self._timeouts, "stale_s": self._pace.stale_s}

    @property
    def _finished(self) -> bool:
        return self._end is not None and self._plant.stamp >= self._end

    def _next_deadline(self, timeout: float) -> float:
        if self.lockstep:
            return time.monotonic() + timeout
        period = to_seconds(self.period) / self._pace.realtime_factor
        now = time.monotonic()
        # Late by more than a few periods: the machine is too slow, so time does not pile up.
        due = (self._deadline or now) + period
        return due if due > now - 5.0 * period else now

    def _time_out(self) -> None:
        if self._paused or self._finished:
            self._deadline = None
            return
        missing = [name for name in COMMANDS if self._stale(name)]
        self._timeouts += 1
        text = (
            f"t = {to_seconds(self._plant.stamp):.2f} s: no {' and no '.join(missing)} in time; "
            "continuing with the safe command"
        )
        self.get_logger().warning(text)
        self.report(self._plant.stamp, diagnostics.WARN, text, lockstep_timeouts=self._timeouts)
        self._advance()

    def _warn_of_stale(self) -> None:
        missing = [name for name in COMMANDS if self._stale(name)]
        if missing and self._plant.stamp > to_nanoseconds(self._pace.stale_s):
            text = f"no {' and no '.join(missing)} for {self._pace.stale_s:g} s; using none"
            self.get_logger().warning(text, throttle_duration_sec=1.0)
            self.report(self._plant.stamp, diagnostics.WARN, text)

    def _stale(self, name: str) -> bool:
        command = self._commands.get(name)
        allowed = 0 if self.lockstep else to_nanoseconds(self._pace.stale_s)
        return command is None or not 0 <= self._plant.stamp - command.stamp <= allowed

    def _usable(self, name: str) -> Any:
        """The command to use; None where there is none, which puts the plant into safe state."""
        return None if self._stale(name) else self._commands[name]

    def _answer_start(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = True, "already running"
        if self._running:
            return response
        if rivals := self._rivals.strangers():
            response.success, response.message = False, _rivals_text(rivals)
            return response
        response.message = "started"
        self._start()
        return response

    def _answer_event(self, request: ApplyEvent.Request, response: ApplyEvent.Response):
        try:
            event = event_from_text(request.event, self._plant.stamp)
            response.message = self._plant.apply(event)
        except ConfigError as fault:
            response.success, response.message = False, str(fault)
            return response
        response.success = True
        self._say_what_happened()
        return response

    def _answer_reset(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        """Back to the start, and time to 0: the other nodes see that and restart.

        A run that is recorded has one time only, and of a short way back nobody would know.
        """
        response.success, least = False, tolerance(self.period)
        if self.run_id:
            response.message = f"run {self.run_id} is being recorded; start another run instead"
            return response
        if 0 < self._plant.stamp <= least:
            response.message = f"not before t = {to_seconds(least):g} s: the nodes would not see it"
            return response
        self._plant = self._make_plant()
        self._commands.clear()
        self._without.clear()
        self._recorded, self._held = 0, False
        self._warned = -DIAGNOSTICS_PERIOD
        if self._running:
            self._start()
        response.success, response.message = True, "back at the start, t = 0"
        return response

    def _answer_pause(self, request: SetBool.Request, response: SetBool.Response):
        was_paused, self._paused, response.success = self._paused, request.data, True
        self._pauses += request.data and not was_paused
        response.message = f"paused at {to_seconds(self._plant.stamp):.2f} s"
        if not request.data:
            response.message = f"continuing from {to_seconds(self._plant.stamp):.2f} s"
            if was_paused:  # otherwise time would skip a period
                self._resume()
        return response

    def _resume(self) -> None:
        if not self._running:
            return
        self._deadline = time.monotonic()
        if not self.lockstep or self._complete():
            self._advance()
        else:
            self._deadline += self._pace.first_timeout_s


def _rivals_text(rivals: Sequence[Endpoint]) -> str:
    return f"another plant is here: {SEPARATOR.join(map(str, rivals))}"


def main(args=None) -> int:
    """`ros2 run uvms_dynamics plant`."""
    return main_of(PlantNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
