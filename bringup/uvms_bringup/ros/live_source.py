"""A running graph as the source of a scene, and the way to ask it for something."""

import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import rclpy
from rclpy.action import ActionClient
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from uvms_bringup.errors import ViewError
from uvms_bringup.ros.asked_parameters import parameters_of
from uvms_bringup.viewer.log_source import WANTED, forces_of, plan_of, posture_of, thrusts_of
from uvms_bringup.viewer.moment import Moment, Thrusts, tool_pose
from uvms_bringup.viewer.overview import TURN_RATE
from uvms_bringup.viewer.water import current_by
from uvms_core import diagnostics, topics
from uvms_core.cdr import codec
from uvms_core.errors import UvmsError
from uvms_core.messages import from_message, to_message
from uvms_core.ros.convert import action_class, message_class, to_ros
from uvms_core.ros.parameters import config_of
from uvms_core.ros.subscribe import qos_profile
from uvms_core.signals import Array, PathGoal, ToolTarget, to_nanoseconds, to_seconds
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_dynamics.simulation.plant.config import PlantConfig
from uvms_planner.config import PlannerConfig

PATIENCE_S = 30.0
"""Wall time within which the graph must answer."""
OPTIONAL_S = 5.0
"""The same for nodes that may not be there: a plant; a planner, if the vehicle is named."""
VEHICLE_FILE = "vehicle_file"
STATE = topics.ODOMETRY, topics.TRUE_ODOMETRY, topics.JOINT_STATES, topics.TRUE_JOINT_STATES
"""The newest of these says how late it is: references are stamped ahead, and targets may have the
clock of whoever leads."""
PLANNING, UNDER_WAY = "sent, being planned", "under way"
"""States of a goal that can be given up."""
BACK_S = 1.0
"""By how much the time must go back for another run to have begun."""
TRAIL = 600
TRAIL_M = 0.002
"""Points of the way that the tool has gone, and how far apart they are at least."""


class LiveSource:
    """Listens to a graph in a thread of its own; `close` ends that.

    Args:
        vehicle_file: of the graph's vehicle; None: as the motion planner of the graph says, whose
            other parameters are taken as `planner`, obstacles included.
        namespace: of the vehicle's topics.
        domain: of the graph; None: as ROS_DOMAIN_ID says.

    Raises:
        ViewError: there is no such graph, or it says nothing.
    """

    def __init__(
        self, vehicle_file: str | None = None, namespace: str = "", domain: int | None = None
    ) -> None:
        self._context = rclpy.Context()
        rclpy.init(
            context=self._context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO
        )
        self._node = Node("viewer", context=self._context, namespace=namespace)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._newest: dict[str, bytes] = {}
        self._thread = threading.Thread(target=self._spin, name="viewer", daemon=True)
        self._thread.start()
        try:
            given = self._planner_parameters(vehicle_file is not None)
            self.planner = config_of(PlannerConfig, given, "parameters of the motion planner")
            self.vehicle: Vehicle = load_vehicle(vehicle_file or given.get(VEHICLE_FILE) or None)
            self._current = self._ask_plant()
        except BaseException:
            self.close()
            raise
        for topic in WANTED:
            self._listen(topic, partial(self._newest.__setitem__, topic.name))
        self._listen(topics.DIAGNOSTICS, self._hear_planner)
        self._lead = self._node.create_publisher(
            message_class(topics.END_EFFECTOR_TARGET),
            topics.END_EFFECTOR_TARGET.name,
            qos_profile(topics.END_EFFECTOR_TARGET.qos),
        )
        action = topics.FOLLOW_END_EFFECTOR_PATH
        self._client = ActionClient(self._node, action_class(action), action.name)
        self._handle: Any = None
        self._is_given_up = False
        self._turned = np.zeros(len(self.vehicle.thrusters))
        self._trail: list[Array] = []
        self._time = 0.0
        self.goal_state = "no goal sent"
        """What became of the goal that was sent last, in words."""
        self.complaint = ""
        """What the planner said last about a goal or target that it does not take."""

    def close(self) -> None:
        """Leave the graph."""
        self._executor.shutdown(timeout_sec=1.0)
        self._context.try_shutdown()
        self._thread.join(1.0)

    def wait(self) -> None:
        """Until the graph has said where vehicle and joints are; raises ViewError."""
        _within(lambda: self.state() is not None, "anybody to publish odometry and joint states")

    def state(self) -> tuple[Any, Any] | None:
        """The newest odometry and joint states; None before both have come."""
        said = self._said()
        names = topics.ODOMETRY.name, topics.JOINT_STATES.name
        if not all(name in said for name in names):
            return None
        return said[names[0]], said[names[1]]

    def moment(self) -> Moment:
        """What is known now."""
        said = self._said()
        now = to_seconds(max((said[t.name].stamp for t in STATE if t.name in said), default=0))
        if now < self._time - BACK_S:
            self._trail = []
        estimate = said.get(topics.ODOMETRY.name)
        estimated = posture_of(said, topics.ODOMETRY.name, topics.JOINT_STATES.name)
        plan = plan_of(said.get(topics.REFERENCE.name), now)
        if estimated is not None:
            self._note_trail(tool_pose(self.vehicle, estimated)[0])
        return Moment(
            now,
            true=posture_of(said, topics.TRUE_ODOMETRY.name, topics.TRUE_JOINT_STATES.name),
            estimated=estimated,
            covariance=None if estimate is None else estimate.pose_covariance,
            thrusts=self._spun(thrusts_of(said), now),
            forces=forces_of(said),
            plan=plan,
            target=None if plan is None else plan[0],
            trail=np.array(self._trail) if len(self._trail) > 1 else None,
            current=None if self._current is None else self._current(now),
        )

    def send(self, goal: PathGoal) -> None:
        """Ask the planner for a path; `goal_state` says what becomes of it."""
        action = topics.FOLLOW_END_EFFECTOR_PATH
        if not self._client.server_is_ready():
            raise ViewError(f"nobody serves the action {action.name!r}: is the planner running?")
        plain = to_message(action, goal, self.vehicle.joint_names)
        message = to_ros(action_class(action).Goal, plain)
        self.goal_state, self.complaint, self._is_given_up = PLANNING, "", False
        self._client.send_goal_async(message).add_done_callback(self._answered)

    def cancel(self) -> None:
        """Ask the planner to give up the goal that was sent last, as soon as it has taken it.

        Raises:
            ViewError: no goal that was sent from here is under way.
        """
        if self.goal_state not in (PLANNING, UNDER_WAY):
            raise ViewError(f"there is no goal to cancel: {self.goal_state}")
        self._is_given_up = True
        if self._handle is not None:
            self._handle.cancel_goal_async()

    def lead(self, target: Array) -> None:
        """Lead the tool to a target (3,) m in map_ned, while no goal is active."""
        topic = topics.END_EFFECTOR_TARGET
        plain = to_message(topic, ToolTarget(to_nanoseconds(self._time), target))
        self._lead.publish(to_ros(message_class(topic), plain))

    def _answered(self, future: Any) -> None:
        handle = future.result()
        if not handle.accepted:
            self.goal_state = "refused by the planner"
            return
        self._handle, self.goal_state = handle, UNDER_WAY
        handle.get_result_async().add_done_callback(self._ended)
        if self._is_given_up:
            handle.cancel_goal_async()

    def _ended(self, future: Any) -> None:
        result = future.result().result
        self._handle = None
        self.goal_state = f"{'done' if result.success else 'not done'}: {result.message}"

    def _hear_planner(self, data: bytes) -> None:
        """Keep what the planner complains of."""
        topic = topics.DIAGNOSTICS
        try:
            status = from_message(topic, codec(topic.type).decode(data))
        except UvmsError:
            return  # of a node that is not ours
        if status.name == topics.MOTION_PLANNER and status.level != diagnostics.OK:
            self.complaint = status.message

    def _spin(self) -> None:
        try:
            self._executor.spin()
        except ExternalShutdownException:
            pass

    def _listen(self, topic: Topic, receive: Callable[[bytes], None]) -> None:
        self._node.create_subscription(
            message_class(topic), topic.name, receive, qos_profile(topic.qos), raw=True
        )

    def _said(self) -> dict[str, Any]:
        """Decoded only when somebody looks: far less often than messages come."""
        said = {}
        for topic in WANTED:
            if (data := self._newest.get(topic.name)) is not None:
                try:
                    said[topic.name] = from_message(topic, codec(topic.type).decode(data))
                except UvmsError:
                    continue  # what is not a signal shows nothing; the nodes report it
        return said

    def _spun(self, thrusts: Thrusts | None, now: float) -> Thrusts | None:
        """Propellers go on turning with the time of the graph."""
        elapsed, self._time = min(max(now - self._time, 0.0), 1.0), now
        if thrusts is None:
            return None
        limits = np.array([item.greatest_n for item in self.vehicle.thrusters])
        self._turned = self._turned + elapsed * TURN_RATE * thrusts.thrust / limits
        return Thrusts(thrusts.thrust, thrusts.saturated, self._turned)

    def _note_trail(self, tool: Array) -> None:
        if not self._trail or np.linalg.norm(tool - self._trail[-1]) > TRAIL_M:
            self._trail = [*self._trail[1 - TRAIL :], tool]

    def _planner_parameters(self, is_optional: bool) -> dict[str, Any]:
        """Of the graph's planner; empty where there is none and none is needed."""
        patience = OPTIONAL_S if is_optional else PATIENCE_S
        given = parameters_of(self._node, topics.MOTION_PLANNER, patience)
        if given is None and not is_optional:
            raise ViewError(
                f"waited {PATIENCE_S:g} s for a motion_planner to answer: is `uvms run` going, with"
                " the same ROS_DOMAIN_ID? Without one, name the vehicle with --vehicle"
            )
        return given or {}

    def _ask_plant(self) -> Callable[[float], Array] | None:
        """The current by the plant's configuration; None where there is no plant of ours."""
        given = parameters_of(self._node, topics.PLANT, OPTIONAL_S)
        if given is None:
            return None
        return current_by(config_of(PlantConfig, given, "parameters of the plant"), self.vehicle)


def _within(ready: Callable[[], bool], what: str) -> None:
    until = time.monotonic() + PATIENCE_S
    while not ready():
        if time.monotonic() > until:
            raise ViewError(f"waited {PATIENCE_S:g} s for {what}")
        time.sleep(0.05)
