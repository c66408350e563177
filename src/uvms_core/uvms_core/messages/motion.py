"""States, wrenches and commands to messages and back."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import (
    Allocation,
    AppliedThrust,
    Array,
    DisturbanceBudget,
    JointCommand,
    JointStates,
    Odometry,
    Payload,
    Stability,
    ThrusterCommand,
    ThrusterHealth,
    Wrench,
)
from uvms_core.topic import Topic


def odometry_to(topic: Topic, value: Odometry, names: Sequence[str]) -> Plain:
    """nav_msgs/Odometry."""
    return {
        "header": parts.header(topic, value.stamp),
        "child_frame_id": topic.child_frame,
        "pose": {
            "pose": parts.pose(value.position, value.quaternion),
            "covariance": value.pose_covariance.ravel(),
        },
        "twist": {
            "twist": parts.twist(value.nu),
            "covariance": value.twist_covariance.ravel(),
        },
    }


def odometry_from(topic: Topic, msg: Any, names: Sequence[str]) -> Odometry:
    """From nav_msgs/Odometry."""
    fields.check_frame(topic, msg.header)
    fields.check_child_frame(topic, msg.child_frame_id)
    pose = msg.pose.pose
    return Odometry(
        fields.stamp_of(msg.header.stamp),
        fields.vector(topic, "pose.pose.position", pose.position),
        fields.quaternion(topic, "pose.pose.orientation", pose.orientation),
        fields.twist(topic, "twist.twist", msg.twist.twist),
        fields.covariance(topic, "pose.covariance", msg.pose.covariance, 6),
        fields.covariance(topic, "twist.covariance", msg.twist.covariance, 6),
    )


def tf_to(topic: Topic, value: Odometry, names: Sequence[str]) -> Plain:
    """tf2_msgs/TFMessage with the vehicle's pose."""
    transform = {
        "header": parts.header(topic, value.stamp),
        "child_frame_id": topic.child_frame,
        "transform": {
            "translation": parts.vector(value.position),
            "rotation": parts.quaternion(value.quaternion),
        },
    }
    return {"transforms": [transform]}


def tf_from(topic: Topic, msg: Any, names: Sequence[str]) -> Odometry:
    """Never: transforms are for viewers, and have no velocities."""
    raise SignalError(f"{topic.name}: carries no signal")


def joints_to(topic: Topic, value: JointStates, names: Sequence[str]) -> Plain:
    """sensor_msgs/JointState."""
    return {
        "header": parts.header(topic, value.stamp),
        "name": list(names),
        "position": parts.floats(value.position),
        "velocity": parts.floats(value.velocity),
        "effort": parts.floats(value.effort),
    }


def joints_from(topic: Topic, msg: Any, names: Sequence[str]) -> JointStates:
    """From sensor_msgs/JointState with position, velocity and effort."""
    fields.check_frame(topic, msg.header)
    index = fields.order(topic, "name", msg.name, names)
    count = len(msg.name)
    return JointStates(
        fields.stamp_of(msg.header.stamp),
        fields.floats(topic, "position", msg.position, count)[index],
        fields.floats(topic, "velocity", msg.velocity, count)[index],
        fields.floats(topic, "effort", msg.effort, count)[index],
    )


def _effort_to(topic: Topic, stamp: int, effort: Any, names: Sequence[str]) -> Plain:
    return {
        "header": parts.header(topic, stamp),
        "name": list(names),
        "position": parts.floats(effort[:0]),
        "velocity": parts.floats(effort[:0]),
        "effort": parts.floats(effort),
    }


def _effort_from(topic: Topic, msg: Any, names: Sequence[str]) -> tuple[int, Any]:
    fields.check_frame(topic, msg.header)
    index = fields.order(topic, "name", msg.name, names)
    effort = fields.floats(topic, "effort", msg.effort, len(msg.name))[index]
    return fields.stamp_of(msg.header.stamp), effort


def joint_command_to(topic: Topic, value: JointCommand, names: Sequence[str]) -> Plain:
    """sensor_msgs/JointState with efforts alone, by joint name."""
    return _effort_to(topic, value.stamp, value.effort, names)


def joint_command_from(topic: Topic, msg: Any, names: Sequence[str]) -> JointCommand:
    """From sensor_msgs/JointState with efforts."""
    return JointCommand(*_effort_from(topic, msg, names))


def thruster_command_to(topic: Topic, value: ThrusterCommand, names: Sequence[str]) -> Plain:
    """sensor_msgs/JointState with thrusts as efforts, by thruster name."""
    return _effort_to(topic, value.stamp, value.thrust, names)


def thruster_command_from(topic: Topic, msg: Any, names: Sequence[str]) -> ThrusterCommand:
    """From sensor_msgs/JointState with thrusts as efforts."""
    return ThrusterCommand(*_effort_from(topic, msg, names))


def wrench_to(topic: Topic, value: Wrench, names: Sequence[str]) -> Plain:
    """geometry_msgs/WrenchStamped."""
    return {"header": parts.header(topic, value.stamp), "wrench": parts.wrench(value.wrench)}


def wrench_from(topic: Topic, msg: Any, names: Sequence[str]) -> Wrench:
    """From geometry_msgs/WrenchStamped."""
    fields.check_frame(topic, msg.header)
    return Wrench(fields.stamp_of(msg.header.stamp), fields.wrench(topic, "wrench", msg.wrench))


def budget_to(topic: Topic, value: DisturbanceBudget, names: Sequence[str]) -> Plain:
    """uvms_msgs/DisturbanceBudget."""
    return {
        "header": parts.header(topic, value.stamp),
        "restoring": parts.wrench(value.restoring),
        "coupling": parts.wrench(value.coupling),
        "external": parts.wrench(value.external),
        "external_sigma": parts.wrench(value.external_sigma),
        "payload": [] if value.payload is None else [_payload_to(value.payload)],
        "thrusters": [] if value.thrusters is None else [_health_to(value.thrusters, names)],
    }


def _payload_to(value: Payload) -> Plain:
    return {
        "held": value.held,
        "mass": value.mass,
        "mass_sigma": value.mass_sigma,
        "weight": value.weight,
        "weight_sigma": value.weight_sigma,
        "position": parts.vector(value.position),
        "position_sigma": parts.vector(value.position_sigma),
    }


def _health_to(value: ThrusterHealth, names: Sequence[str]) -> Plain:
    return {
        "thruster_names": list(names),
        "effectiveness": parts.floats(value.effectiveness),
        "sigma": parts.floats(value.sigma),
    }


def budget_from(topic: Topic, msg: Any, names: Sequence[str]) -> DisturbanceBudget:
    """From uvms_msgs/DisturbanceBudget."""
    fields.check_frame(topic, msg.header)
    return DisturbanceBudget(
        fields.stamp_of(msg.header.stamp),
        fields.wrench(topic, "restoring", msg.restoring),
        fields.wrench(topic, "coupling", msg.coupling),
        fields.wrench(topic, "external", msg.external),
        *_explained_from(topic, msg, names),
    )


def _explained_from(
    topic: Topic, msg: Any, names: Sequence[str]
) -> tuple[Array, Payload | None, ThrusterHealth | None]:
    """What logs from before these fields do not have is not known."""
    if not hasattr(msg, "external_sigma"):
        return np.zeros(6), None, None
    for name, found in (("payload", msg.payload), ("thrusters", msg.thrusters)):
        if len(found) > 1:
            raise SignalError(f"{topic.name}: {name} has {len(found)} values; it may have one")
    return (
        fields.wrench(topic, "external_sigma", msg.external_sigma),
        _payload_from(topic, msg.payload[0]) if msg.payload else None,
        _health_from(topic, msg.thrusters[0], names) if msg.thrusters else None,
    )


def _payload_from(topic: Topic, msg: Any) -> Payload:
    mass, mass_sigma, weight, weight_sigma = (
        fields.number(topic, f"payload.{name}", getattr(msg, name))
        for name in ("mass", "mass_sigma", "weight", "weight_sigma")
    )
    return Payload(
        bool(msg.held),
        mass,
        mass_sigma,
        weight,
        weight_sigma,
        fields.vector(topic, "payload.position", msg.position),
        fields.vector(topic, "payload.position_sigma", msg.position_sigma),
    )


def _health_from(topic: Topic, msg: Any, names: Sequence[str]) -> ThrusterHealth:
    index = fields.order(topic, "thrusters.thruster_names", msg.thruster_names, names)
    count = len(msg.thruster_names)
    return ThrusterHealth(
        fields.floats(topic, "thrusters.effectiveness", msg.effectiveness, count)[index],
        fields.floats(topic, "thrusters.sigma", msg.sigma, count)[index],
    )


def allocation_to(topic: Topic, value: Allocation, names: Sequence[str]) -> Plain:
    """uvms_msgs/Allocation."""
    return {
        "header": parts.header(topic, value.stamp),
        "thruster_names": list(names),
        "thrust": parts.floats(value.thrust),
        "saturated": value.saturated.tolist(),
        "achieved": parts.wrench(value.achieved),
        "residual": parts.wrench(value.residual),
        "effectiveness": parts.floats(value.effectiveness),
    }


def allocation_from(topic: Topic, msg: Any, names: Sequence[str]) -> Allocation:
    """From uvms_msgs/Allocation."""
    fields.check_frame(topic, msg.header)
    index = fields.order(topic, "thruster_names", msg.thruster_names, names)
    count = len(msg.thruster_names)
    saturated = np.array(msg.saturated, dtype=np.bool_)
    if saturated.shape != (count,):
        raise SignalError(
            f"{topic.name}: saturated has {saturated.size} values; it must have {count}"
        )
    return Allocation(
        fields.stamp_of(msg.header.stamp),
        fields.floats(topic, "thrust", msg.thrust, count)[index],
        fields.wrench(topic, "achieved", msg.achieved),
        fields.wrench(topic, "residual", msg.residual),
        saturated[index],
        _effectiveness_from(topic, msg, count, index),
    )


def _effectiveness_from(topic: Topic, msg: Any, count: int, index: Any) -> Array:
    """Empty where all thrusters are whole, and in logs from before this field."""
    values = getattr(msg, "effectiveness", ())
    if not len(values):
        return np.empty(0)
    return fields.floats(topic, "effectiveness", values, count)[index]


def stability_to(topic: Topic, value: Stability, names: Sequence[str]) -> Plain:
    """uvms_msgs/ControlStability."""
    return {
        "header": parts.header(topic, value.stamp),
        "lyapunov": value.lyapunov,
        "lyapunov_rate": value.lyapunov_rate,
        "demand": value.demand,
        "supply": value.supply,
    }


def stability_from(topic: Topic, msg: Any, names: Sequence[str]) -> Stability:
    """From uvms_msgs/ControlStability."""
    fields.check_frame(topic, msg.header)
    return Stability(
        fields.stamp_of(msg.header.stamp),
        *(
            fields.number(topic, name, getattr(msg, name))
            for name in ("lyapunov", "lyapunov_rate", "demand", "supply")
        ),
    )


def applied_to(topic: Topic, value: AppliedThrust, names: Sequence[str]) -> Plain:
    """uvms_msgs/AppliedThrust."""
    return {
        "header": parts.header(topic, value.stamp),
        "thruster_names": list(names),
        "thrust": parts.floats(value.thrust),
        "commanded": parts.floats(value.commanded),
        "thruster_command_stamp": parts.time(value.thruster_command_stamp),
        "joint_command_stamp": parts.time(value.joint_command_stamp),
        "thruster_safe": value.thruster_safe,
        "joint_safe": value.joint_safe,
    }


def applied_from(topic: Topic, msg: Any, names: Sequence[str]) -> AppliedThrust:
    """From uvms_msgs/AppliedThrust."""
    fields.check_frame(topic, msg.header)
    index = fields.order(topic, "thruster_names", msg.thruster_names, names)
    count = len(msg.thruster_names)
    return AppliedThrust(
        fields.stamp_of(msg.header.stamp),
        fields.floats(topic, "thrust", msg.thrust, count)[index],
        fields.floats(topic, "commanded", msg.commanded, count)[index],
        fields.stamp_of(msg.thruster_command_stamp),
        fields.stamp_of(msg.joint_command_stamp),
        bool(msg.thruster_safe),
        bool(msg.joint_safe),
    )
