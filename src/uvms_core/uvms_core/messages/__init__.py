"""Signals to messages and back, free of ROS.

`to_message` gives a nested dict of plain values: numbers, texts, lists, `array.array` for float64
sequences and flat float64 arrays for covariances. `from_message` reads the attributes of any
message-like object (an rclpy message, or one decoded from a log), checks it and gives the signal.
Every float64 and every stamp comes back exactly.
"""

from collections.abc import Sequence
from typing import Any

from uvms_core import signals
from uvms_core.checks import trust
from uvms_core.diagnostics import Status
from uvms_core.errors import SignalError
from uvms_core.messages import actions, battery, general, motion, reference
from uvms_core.topic import Action, Conversion, Topic

_CONVERSIONS: dict[type, Conversion] = {
    int: Conversion(general.clock_to, general.clock_from),
    Status: Conversion(general.status_to, general.status_from),
    signals.JointStates: Conversion(motion.joints_to, motion.joints_from),
    signals.SensorGaps: Conversion(general.gaps_to, general.gaps_from),
    signals.Odometry: Conversion(motion.odometry_to, motion.odometry_from),
    signals.Wrench: Conversion(motion.wrench_to, motion.wrench_from),
    signals.DisturbanceBudget: Conversion(motion.budget_to, motion.budget_from),
    signals.JointCommand: Conversion(motion.joint_command_to, motion.joint_command_from),
    signals.ThrusterCommand: Conversion(motion.thruster_command_to, motion.thruster_command_from),
    signals.Allocation: Conversion(motion.allocation_to, motion.allocation_from),
    signals.Stability: Conversion(motion.stability_to, motion.stability_from),
    signals.AppliedThrust: Conversion(motion.applied_to, motion.applied_from),
    signals.BatteryState: Conversion(battery.battery_to, battery.battery_from),
    signals.Reference: Conversion(reference.reference_to, reference.reference_from),
    signals.PathGoal: Conversion(actions.path_to, actions.path_from),
    signals.JointGoal: Conversion(actions.joints_to, actions.joints_from),
    signals.PoseGoal: Conversion(actions.pose_to, actions.pose_from),
}


def _conversion(topic: Topic | Action) -> Conversion:
    if isinstance(topic, Action):
        return _CONVERSIONS[topic.goal]
    if topic.conversion is not None:
        return topic.conversion
    if topic.signal is None:
        raise SignalError(f"{topic.name}: carries no signal")
    return _CONVERSIONS[topic.signal]


def to_message(topic: Topic | Action, signal: Any, names: Sequence[str] = ()) -> dict[str, Any]:
    """The message of a signal on its topic (or the goal of an action) as a nested dict.

    `names` are those of the joints or thrusters, for the messages that carry them.
    """
    return _conversion(topic).to_message(topic, signal, names)


def from_message(topic: Topic | Action, msg: Any, names: Sequence[str] = ()) -> Any:
    """The signal that a message on a topic (or the goal of an action) carries, marked as checked.

    Values that come by name are brought into the order of `names`; without `names` they keep
    theirs. Raises SignalError, which names topic, field and value, where a frame id, a length, a
    name or a quaternion's length is wrong or a value is not finite.
    """
    return trust(_conversion(topic).from_message(topic, msg, names))
