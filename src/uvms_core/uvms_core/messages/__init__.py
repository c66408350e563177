"""Signals to messages and back, free of ROS.

`to_message` gives a nested dict of plain values: numbers, texts, lists, `array.array` for float64
sequences and flat float64 arrays for covariances. `from_message` reads the attributes of any
message-like object, be it an rclpy message or one decoded from a log, checks it and gives the
signal. Every float64 and every stamp comes back exactly.
"""

from collections.abc import Callable, Sequence
from typing import Any

from uvms_core import signals
from uvms_core.diagnostics import Status
from uvms_core.errors import SignalError
from uvms_core.messages import actions, general, motion, reference, sensors
from uvms_core.topics import TF, Action, Topic

To = Callable[[Any, Any, Sequence[str]], dict[str, Any]]
From = Callable[[Any, Any, Sequence[str]], Any]

_CONVERSIONS: dict[type, tuple[To, From]] = {
    int: (general.clock_to, general.clock_from),
    Status: (general.status_to, general.status_from),
    signals.ImuSample: (sensors.imu_to, sensors.imu_from),
    signals.DvlSample: (sensors.dvl_to, sensors.dvl_from),
    signals.PressureSample: (sensors.pressure_to, sensors.pressure_from),
    signals.GpsSample: (sensors.gps_to, sensors.gps_from),
    signals.JointStates: (motion.joints_to, motion.joints_from),
    signals.Odometry: (motion.odometry_to, motion.odometry_from),
    signals.Wrench: (motion.wrench_to, motion.wrench_from),
    signals.DisturbanceBudget: (motion.budget_to, motion.budget_from),
    signals.JointCommand: (motion.joint_command_to, motion.joint_command_from),
    signals.ThrusterCommand: (motion.thruster_command_to, motion.thruster_command_from),
    signals.Allocation: (motion.allocation_to, motion.allocation_from),
    signals.Reference: (reference.reference_to, reference.reference_from),
    signals.PathGoal: (actions.path_to, actions.path_from),
    signals.JointGoal: (actions.joints_to, actions.joints_from),
}


def _kind(topic: Topic | Action) -> type:
    kind = topic.goal if isinstance(topic, Action) else topic.signal
    if kind is None or topic.name == TF.name:
        raise SignalError(f"{topic.name}: carries no signal")
    return kind


def to_message(topic: Topic | Action, signal: Any, names: Sequence[str] = ()) -> dict[str, Any]:
    """The message of a signal on its topic (or the goal of an action) as a nested dict.

    `names` are those of the joints or thrusters, for the messages that carry them.
    """
    if topic.name == TF.name:
        return motion.tf_to(TF, signal, names)
    return _CONVERSIONS[_kind(topic)][0](topic, signal, names)


def from_message(topic: Topic | Action, msg: Any, names: Sequence[str] = ()) -> Any:
    """The signal that a message on a topic (or the goal of an action) carries.

    Values that come by name are brought into the order of `names`; without `names` they keep
    theirs. Raises SignalError, which names topic, field and value, where a frame id, a length, a
    name or a quaternion's length is wrong or a value is not finite.
    """
    return _CONVERSIONS[_kind(topic)][1](topic, msg, names)
