"""Takes what a terminal shows out of the messages of a run as they are recorded."""

from collections import deque
from typing import Any

import numpy as np

from uvms_analysis.happened import events_in
from uvms_analysis.limits import END_EFFECTOR
from uvms_bringup.terminal.glance import Battery, Bounded, Health, Measured, Push, Thruster
from uvms_bringup.viewer.log_source import AGE_S, PLAN_AGE_S, plan_of, posture_of, thrusts_of
from uvms_bringup.viewer.moment import tool_pose
from uvms_core import diagnostics, topics
from uvms_core.cdr import codec
from uvms_core.diagnostics import Status
from uvms_core.errors import UvmsError
from uvms_core.messages import from_message
from uvms_core.rotations import quat_to_rpy
from uvms_core.signals import Array, BatteryState, to_nanoseconds, to_seconds
from uvms_core.topic import Topic
from uvms_core.vehicle import Vehicle
from uvms_planner.config import LimitsConfig

HEARD = (
    topics.ODOMETRY,
    topics.JOINT_STATES,
    topics.APPLIED_THRUST,
    topics.ALLOCATION,
    topics.DISTURBANCE_BUDGET,
    topics.BATTERY_STATE,
)
"""Their newest messages are decoded when somebody looks, far less often than they come."""
BATTERY_AGE_S = 2.5 * topics.BATTERY_PERIOD_S
"""The battery is heard once a second."""
REFERENCES = 8
"""References are stamped ahead: of so many the newest that has begun counts."""
EVENTS = 3
"""So many of the last events are shown."""


class Listener:
    """Remembers the newest messages of a run; cheap when called often.

    Args:
        vehicle: of the run.
        limits: the planner's, for roll and pitch.
        namespace: of the run's topics.
    """

    def __init__(self, vehicle: Vehicle, limits: LimitsConfig, namespace: str = "") -> None:
        self._vehicle, self._limits = vehicle, limits
        self._names = {topic.resolve(namespace): topic for topic in HEARD}
        self._reference = topics.REFERENCE.resolve(namespace)
        self._diagnostics = topics.DIAGNOSTICS.resolve(namespace)
        self._newest: dict[str, tuple[int, bytes]] = {}
        self._references: deque[tuple[int, bytes]] = deque(maxlen=REFERENCES)
        self._unread: list[bytes] = []  # of /diagnostics
        self._statuses: dict[str, Status] = {}  # newest by node
        self._events: deque[tuple[float, str]] = deque(maxlen=EVENTS)

    def hear(self, name: str, stamp: int, data: bytes) -> None:
        """Take a message: full name of its topic, stamp in ns, CDR bytes."""
        if name in self._names:
            self._newest[name] = stamp, data
        elif name == self._reference:
            self._references.append((stamp, data))
        elif name == self._diagnostics:
            self._unread.append(data)

    def measured(self, stamp: int) -> Measured:
        """What is known at a stamp in ns; what is older than a second counts no more.

        Of the battery, what is older than `BATTERY_AGE_S`.
        """
        self._read_statuses()
        said = self._said(stamp)
        odometry, budget = (
            said.get(topic.name) for topic in (topics.ODOMETRY, topics.DISTURBANCE_BUDGET)
        )
        rpy = (None, None) if odometry is None else np.rad2deg(quat_to_rpy(odometry.quaternion))
        return Measured(
            tool=Bounded(self._tool_error_mm(said), 1e3 * END_EFFECTOR.near, "mm"),
            roll=Bounded(_number(rpy[0]), self._limits.roll_max_deg, "deg"),
            pitch=Bounded(_number(rpy[1]), self._limits.pitch_max_deg, "deg"),
            thrusters=self._thrusters(said),
            restoring=None if budget is None else _push(budget.restoring),
            coupling=None if budget is None else _push(budget.coupling),
            external=None if budget is None else _push(budget.external),
            battery=_battery(said.get(topics.BATTERY_STATE.name)),
            health=self._health(said),
            events=tuple(self._events),
        )

    def _said(self, stamp: int) -> dict[str, Any]:
        fresh = (
            (name, data)
            for name, (at, data) in self._newest.items()
            if at >= stamp - to_nanoseconds(_age_s(self._names[name]))
        )
        decoded = ((self._names[name], _decoded(self._names[name], data)) for name, data in fresh)
        return {topic.name: signal for topic, signal in decoded if signal is not None}

    def _tool_error_mm(self, said: dict[str, Any]) -> float | None:
        """Distance of the estimated tool from where the plan wants it at the same time, mm."""
        posture = posture_of(said, topics.ODOMETRY.name, topics.JOINT_STATES.name)
        if posture is None:
            return None
        stamp = said[topics.ODOMETRY.name].stamp
        begun = [data for at, data in self._references if at <= stamp]
        reference = _decoded(topics.REFERENCE, begun[-1]) if begun else None
        if reference is None or stamp - reference.stamp > to_nanoseconds(PLAN_AGE_S):
            return None
        plan = plan_of(reference, to_seconds(stamp))
        if plan is None:
            return None
        return float(1e3 * np.linalg.norm(tool_pose(self._vehicle, posture)[0] - plan[0]))

    def _thrusters(self, said: dict[str, Any]) -> tuple[Thruster, ...]:
        given = thrusts_of(said)
        return tuple(
            Thruster(
                own.name,
                None if given is None else float(given.thrust[index]),
                own.astern_n,
                own.ahead_n,
                False if given is None else bool(given.saturated[index]),
            )
            for index, own in enumerate(self._vehicle.thrusters)
        )

    def _read_statuses(self) -> None:
        unread, self._unread = self._unread, []
        for data in unread:
            if (status := _decoded(topics.DIAGNOSTICS, data)) is not None:
                self._statuses[status.name] = status
                if status.name == topics.PLANT:
                    self._events += [(each["at_s"], each["text"]) for each in events_in(status)]

    def _health(self, said: dict[str, Any]) -> Health | None:
        """None before anything has come; nodes that complain of nothing are well."""
        if not said and not self._statuses:
            return None
        worst = max(self._statuses.values(), key=lambda status: status.level, default=None)
        if worst is None or worst.level == diagnostics.OK:
            return Health(diagnostics.OK)
        return Health(worst.level, worst.name, worst.message)


def _decoded(topic: Topic, data: bytes) -> Any:
    """The signal; None for what is none: the nodes report it."""
    try:
        return from_message(topic, codec(topic.type).decode(data))
    except UvmsError:
        return None


def _age_s(topic: Topic) -> float:
    return BATTERY_AGE_S if topic is topics.BATTERY_STATE else AGE_S


def _battery(said: BatteryState | None) -> Battery | None:
    return None if said is None else Battery(said.percentage, said.voltage, said.power)


def _number(value: float | None) -> float | None:
    return None if value is None else float(value)


def _push(wrench: Array) -> Push:
    return Push(float(np.linalg.norm(wrench[:3])), float(np.linalg.norm(wrench[3:])))
