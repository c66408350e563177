"""The conductor of a run: waits for the nodes, sends the goal, starts time, monitors, records."""

import math
import sys
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.node import Node
from std_srvs.srv import SetBool, Trigger

from uvms_bringup.agenda import Agenda, Goals
from uvms_bringup.errors import RunError
from uvms_bringup.ros.acknowledge import Acknowledgement
from uvms_bringup.ros.goal_sender import GoalSender, refusal
from uvms_bringup.ros.graph_watch import CONDUCTOR, DISCOVERY_S, REST_S, GraphWatch
from uvms_bringup.ros.losses import Losses
from uvms_bringup.ros.recorder import Recorder, Write
from uvms_bringup.ros.state_publisher import StateBroadcaster
from uvms_bringup.ros.turns import FIND_S, Turns
from uvms_bringup.stopped import Stopped
from uvms_core import diagnostics, topics
from uvms_core.messages import from_message
from uvms_core.ros.convert import message_class
from uvms_core.ros.request import Request
from uvms_core.ros.roll_call import NO_ANSWER, NOT_UP, RollCall
from uvms_core.ros.spin import Spinner
from uvms_core.ros.subscribe import qos_profile
from uvms_core.signals import Goal
from uvms_core.topic import NodeTopics, Topic
from uvms_core.vehicle import Vehicle

START_PATIENCE_S = 180.0
"""Wall time for all nodes to come up and find each other; the first start compiles kernels."""
ANSWER_PATIENCE_S = 60.0
END_PATIENCE_S = 2.0
COUNT_PATIENCE_S = 3.0
"""Wall time at the end of a run for the nodes to count and for their last messages to arrive."""
NOTICE_S = 10.0
"""Wall time between two lines on what is being waited for."""
FOREIGN_SETTLE_S = 1.0
"""Wall time in which nodes that do not answer to the roll call find their listeners."""
SETTLE_S = 0.3
"""Wall time after the last answers for messages still in flight, such as a reference."""

GOAL_STATES = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_CANCELED: "canceled",
    GoalStatus.STATUS_ABORTED: "aborted",
}

LOOP_END = (
    topics.THRUSTER_COMMAND,
    topics.JOINT_COMMAND,
    topics.WRENCH_ACHIEVED,
    topics.ALLOCATION,
)


class Conductor(Node):
    """Conducts a run from the first tick to the last and hands every message to `write`.

    Args:
        write: takes every message, as `Recorder` says.
        watch: called while waiting; raises if the run cannot continue.
        joint_names: in the vehicle's order, for goals that name the joints.
        recorded: topics of the run, `topics.of(vehicle)`.
        graph: what each node reads and writes, `topics.nodes(vehicle)`.
        foreign: roles that are filled by nodes which do not answer to the roll call.
        absent: of these, the ones that a person starts: they are waited for without end.
        waiting: called while waiting, with what says for what.
    """

    def __init__(
        self,
        write: Write,
        watch: Callable[[], None],
        joint_names: Sequence[str],
        recorded: Sequence[Topic] = topics.ALL,
        graph: Mapping[str, NodeTopics] = topics.NODES,
        foreign: Collection[str] = (),
        absent: Collection[str] = (),
        waiting: Callable[[Callable[[], str]], None] = lambda lack: None,
        **options: Any,
    ) -> None:
        super().__init__(CONDUCTOR, **options)
        self._graph, self._foreign, self._patient = graph, foreign, bool(absent)
        self.graph_watch = GraphWatch(self, graph, absent)
        self._goals = GoalSender(self, joint_names, self._take_feedback)
        self.recorder = Recorder(self, write, recorded)
        self._watch, self._waiting = watch, waiting
        self._end: tuple[Topic, ...] = LOOP_END
        self._faults: dict[str, str] = {}
        self._asked = {diagnostics.GOALS_ACCEPTED: 0, diagnostics.PAUSES: 0}
        self.feedback: Any = None
        self.result: Any = None
        self.result_status: int | None = None  # action_msgs/msg/GoalStatus
        self.goal_handle: Any = None
        self.agenda = Agenda(None)
        self._navigation = ""  # what it said last
        self._sent: Request | None = None  # a further goal that has been sent
        self.create_subscription(
            message_class(topics.DIAGNOSTICS),
            topics.DIAGNOSTICS.name,
            self._take_status,
            qos_profile(topics.DIAGNOSTICS.qos),
        )
        self._roll_call = RollCall(self, graph, foreign, graph=graph)
        self.acknowledgement: Acknowledgement | None = None
        self.losses = Losses(self, self.recorder, set(graph) - set(foreign))
        self._start = self.create_client(Trigger, "start")
        self._pause = self.create_client(SetBool, "pause")
        self._turns = Turns(self, self._pause)

    def broadcast(self, vehicle: Vehicle, lockstep: bool) -> None:
        """From now on publish /tf and robot_description from the recorded messages."""
        states = StateBroadcaster(self, vehicle, lockstep)
        self.recorder.receivers.update(states.receivers)
        self._end = (*LOOP_END, topics.TF)

    def acknowledge(self, period: int, window: int, sampled: Mapping[str, Topic]) -> None:
        """From now on tell the plant what is recorded, as `Acknowledgement` says."""
        further = [topic for topic in self._end if topic is topics.TF]
        self.acknowledgement = Acknowledgement(
            self, self.recorder, self._graph, self._foreign, further, sampled, period, window
        )

    def check_alone(self, spinner: Spinner, others: bool) -> None:
        """Look whether the graph is empty, as `GraphWatch.check_alone` says.

        `others`: whether there may be somebody in the domain, whom to find takes time.
        """
        found = time.monotonic() + DISCOVERY_S * others
        while time.monotonic() < found:
            self._watch()
            self._check_stopped(spinner)
            spinner.spin_once(0.05)
            if self.graph_watch.sees_others():  # the rest of them will be found soon
                found = min(found, time.monotonic() + REST_S)
        self.graph_watch.check_alone()

    @property
    def stamp(self) -> int:
        """Newest simulation time, ns."""
        return self.recorder.stamp

    def conduct(self, spinner: Spinner, goal: Goals) -> None:
        """Bring the run to its first tick, send the goal and start time."""
        self.recorder.on_clock = spinner.yield_turn
        self._await_nodes(spinner)
        self.graph_watch.check_alone_with_nodes()
        self._await(
            spinner, self.losses.begun, ANSWER_PATIENCE_S, lambda: "what the nodes have sent so far"
        )
        self._call(spinner, self._start, Trigger.Request(), "plant/start")
        self._await(
            spinner,
            lambda: topics.THRUSTER_COMMAND.name in self.recorder.newest,
            START_PATIENCE_S,
            lambda: f"the first thruster_command; nothing yet from {', '.join(self._silent())}",
        )
        self.agenda = Agenda(goal)
        first, knows = self.agenda.due, topics.ODOMETRY.name in self.recorder.newest
        if self.agenda.remaining > int(knows):
            self._take_turns(spinner)
        if first is not None and knows:
            self.send_goal(spinner, first)
            self.agenda.begin(self.stamp)
        self._call(spinner, self._pause, SetBool.Request(data=False), "plant/pause")

    def arrived(self, end: int) -> bool:
        """Whether the plant has reached `end` and the answers to its last tick are recorded."""
        newest = self.recorder.newest
        if self.stamp < end:
            self._arrival = None
            return False
        self._arrival = self._arrival or time.monotonic()
        waited = time.monotonic() - self._arrival
        if all(newest.get(topic.name, -1) >= end for topic in self._end):
            self._answered = self._answered or time.monotonic()
            return time.monotonic() - self._answered > SETTLE_S
        return waited > END_PATIENCE_S

    _arrival: float | None = None
    _answered: float | None = None

    def _await_nodes(self, spinner: Spinner) -> None:
        self._await(
            spinner,
            lambda: not self._roll_call.poll(),
            math.inf if self._patient else START_PATIENCE_S,
            lambda: _missing(self._roll_call.poll(), self._foreign),
        )
        if self._foreign:  # nobody knows whether these have found their listeners
            settled = time.monotonic() + FOREIGN_SETTLE_S
            while time.monotonic() < settled:
                self._watch()
                spinner.spin_once(0.05)

    def _silent(self) -> list[str]:
        newest = self.recorder.newest
        return [
            node
            for node, own in self._graph.items()
            if all(topic.name not in newest for topic in own.outputs)
        ]

    def _take_turns(self, spinner: Spinner) -> None:
        """In lockstep no time passes between two goals, where the planner can wait for them."""
        if self.acknowledgement is None or topics.MOTION_PLANNER in self._foreign:
            return
        found = time.monotonic() + FIND_S
        while not self._turns.is_possible() and time.monotonic() < found:
            spinner.spin_once(0.05)
        if self._turns.is_possible():
            self._turns.begin()
            self._await(
                spinner, self._turns.settled, ANSWER_PATIENCE_S, lambda: "a planner that waits"
            )

    def send_goal(self, spinner: Spinner, goal: Goal) -> None:
        """Ask the planner for a goal; RunError with its reason where it is rejected."""
        name = topics.action_of(goal).name
        self._await(
            spinner,
            lambda: self._goals.is_ready(goal),
            ANSWER_PATIENCE_S,
            lambda: f"a server of the action {name!r}",
        )
        self._faults.clear()
        request = self._goals.request(goal)
        handle = self._answer_to(spinner, request, f"motion_planner: {name}", "a plan, ")
        reason = "" if handle.accepted else self._reason(spinner)
        if (why := refusal(handle, request, reason)) is not None:
            raise RunError(f"the planner rejected the goal: {why}")
        self.goal_handle = handle
        handle.get_result_async().add_done_callback(self._take_result)

    def _reason(self, spinner: Spinner) -> str:
        # An action's rejection carries no text; the planner gives its reason on /diagnostics.
        deadline = time.monotonic() + END_PATIENCE_S
        while time.monotonic() < deadline:
            if topics.MOTION_PLANNER in self._faults:
                return self._faults[topics.MOTION_PLANNER]
            spinner.spin_once(0.05)
        return ""

    def _call(self, spinner: Spinner, client: Any, request: Any, name: str) -> None:
        asked = Request(lambda: client.call_async(request), client.service_is_ready)
        answer = self._answer_to(spinner, asked, name)
        if not answer.success:
            raise RunError(f"{name}: {answer.message}")

    def _answer_to(self, spinner: Spinner, request: Request, name: str, what: str = "") -> Any:
        self._await(
            spinner,
            lambda: request.answer() is not None,
            ANSWER_PATIENCE_S,
            lambda: f"{what}an answer from {name}",
        )
        return request.answer()

    def _await(
        self, spinner: Spinner, ready: Callable[[], bool], patience: float, lack: Callable[[], str]
    ) -> None:
        began = time.monotonic()
        deadline, notice = began + patience, began + NOTICE_S
        while not ready():
            self._watch()
            self._waiting(lack)
            if time.monotonic() > notice:
                notice += NOTICE_S
                waited = time.monotonic() - began
                print(f"waiting for: {lack()} ({waited:.0f} s)", file=sys.stderr, flush=True)
            self._check_stopped(spinner)
            if time.monotonic() > deadline:
                raise RunError(f"timed out after {patience:.0f} s waiting for: {lack()}")
            spinner.spin_once(0.05)

    @staticmethod
    def _check_stopped(spinner: Spinner) -> None:
        if spinner.signal:
            raise Stopped(spinner.signal)
        if spinner.done.done():
            raise RunError("stopped before the run began")

    def count(self, spinner: Spinner) -> list[str]:
        """Compare what the nodes sent with what is recorded; returns who gave no count.

        Time is paused first, so that nothing is on its way when they count.
        """
        paused = self._pause.call_async(SetBool.Request(data=True))
        deadline = time.monotonic() + COUNT_PATIENCE_S
        while not paused.done() and time.monotonic() < deadline - 0.5 * COUNT_PATIENCE_S:
            spinner.serve(0.05)
        settled = time.monotonic() + SETTLE_S  # for the answers to the last tick
        while self._arrival is None and time.monotonic() < settled:
            spinner.serve(0.05)
        while not self.losses.ended() and time.monotonic() < deadline:
            spinner.serve(0.05)
        return self.losses.silent()

    def goal_state(self) -> str:
        """What became of the last goal that was sent, as `RunEnd.goal` has it."""
        if self.goal_handle is None:
            return "none"
        return GOAL_STATES.get(self.result_status or 0, "running")

    def hear(self) -> None:
        """Note the end of the goal that is active."""
        if self.agenda.active and self.result is not None:
            self.agenda.end(self.stamp, self.goal_state(), self.result.message)

    def go_on(self) -> None:
        """Where a goal has succeeded, ask for the next one.

        The first one is asked for here where navigation did not know the place at the start. In
        lockstep time stands still meanwhile, as `Turns` says; else it goes on.
        """
        self.hear()
        goal = self.agenda.due
        if goal is None or topics.REFERENCE.name not in self.recorder.newest:
            self._turns.settled()
        elif not self._turns.hold() or not self._goals.is_ready(goal):
            return
        elif self._sent is None:
            self._faults.clear()
            self._sent = self._goals.request(goal)
        elif (handle := self._sent.answer()) is not None:
            self._take_answer(handle, self._sent)

    def ask_again(self) -> None:
        """The planner was started again: it knows nothing of what it was asked."""
        self._sent = None

    def _take_answer(self, handle: Any, request: Request) -> None:
        self._sent = None
        why = refusal(handle, request, self._faults.get(topics.MOTION_PLANNER, ""))
        if why is not None:
            self.agenda.refuse(self.stamp, why)
        else:
            self.goal_handle, self.result, self.result_status = handle, None, None
            self.feedback = None
            self.agenda.begin(self.stamp)
            handle.get_result_async().add_done_callback(self._take_result)
        self._turns.go_on(self.agenda.remaining > 0)

    def goal_failure(self) -> list[str]:
        """Why the run's goal did not succeed, in the planner's words, where it has ended."""
        if self.result is None or self.result.success:
            return []
        return [f"the run's goal: {self.result.message}"]

    def _take_status(self, msg: Any) -> None:
        status = from_message(topics.DIAGNOSTICS, msg)
        if status.name == topics.NAVIGATION:
            self._navigation = status.message
        if status.level == diagnostics.ERROR:
            self._faults[status.name] = status.message
        for key in self._asked:
            count = status.number(key)
            if count == count:  # NaN: this node does not count it
                self._asked[key] = max(self._asked[key], int(count))

    def interference(self) -> list[str]:
        """What somebody else asked of the run's nodes, in words."""
        own = self.agenda.begun + (self._sent is not None)  # its acceptance may be counted first
        goals = self._asked[diagnostics.GOALS_ACCEPTED] - own
        pauses = self._asked[diagnostics.PAUSES] - self._turns.pauses
        found = [f"the planner accepted {goals} goals that were not this run's"] * (goals > 0)
        return found + [f"time was held {pauses} times by whoever called pause"] * (pauses > 0)

    def _take_feedback(self, msg: Any) -> None:
        self.feedback = msg.feedback

    def _take_result(self, answer: Any) -> None:
        self.result, self.result_status = answer.result().result, answer.result().status

    def phase(self) -> str:
        """What the run is at, for who watches it."""
        if topics.ODOMETRY.name not in self.recorder.newest:
            return f"waiting for navigation: {self._navigation}"
        if self.agenda.active and hasattr(self.feedback, "distance"):
            return f"{self.agenda.phase}: {self.feedback.distance:.2f} m to go"
        return self.agenda.phase


def _missing(lacks: dict[str, str], foreign: Collection[str] = ()) -> str:
    """Who is missing; a node that is not there is the reason why the others lack its topics."""
    absent = {
        node: lack for node, lack in lacks.items() if lack in (NOT_UP, NO_ANSWER) or node in foreign
    }
    return "; ".join(f"{node}: {lack}" for node, lack in (absent or lacks).items())
