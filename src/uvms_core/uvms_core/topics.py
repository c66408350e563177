"""Every topic of the system, once: name, type, signal, frame, quality of service.

Nodes, recorder, in-process simulation and report all take names and types from here. Names are
relative, so that they fall under the vehicle's namespace; /clock, /tf, /tf_static and /diagnostics
are global, as everywhere in ROS. docs/signals.md has this table with units and rates.

The constants are those of a vehicle with the built-in sensors and a battery; `of` and `nodes` give
what a vehicle with further sensors, or without a battery, has.
"""

from collections.abc import Iterable, Mapping

from uvms_core import diagnostics, sensors, signals
from uvms_core.messages import motion, target
from uvms_core.topic import (
    BODY_FRAME,
    LATCHED,
    SENSORS,
    WORLD_FRAME,
    Action,
    Conversion,
    Kind,
    NodeTopics,
    Qos,
    Topic,
)
from uvms_core.vehicle.vehicle import Vehicle

__all__ = [
    "ACTIONS",
    "ALL",
    "BODY_FRAME",
    "BY_NAME",
    "COMPANIONS",
    "CONTROLLER",
    "DISTURBANCE_OBSERVER",
    "ENCODERS",
    "END_EFFECTOR_TARGET",
    "GAPS",
    "LATCHED",
    "MOTION_PLANNER",
    "NAVIGATION",
    "NODES",
    "ODOMETRY_GAPS",
    "PLANT",
    "RECORDED",
    "ROSOUT",
    "SENSOR_GAPS",
    "THRUST_ALLOCATOR",
    "WORLD_FRAME",
    "Action",
    "Kind",
    "NodeTopics",
    "Qos",
    "Topic",
    "action_of",
    "contract",
    "nodes",
    "of",
    "readers",
    "sampled_topics",
]

Sampled = sensors.SensorType | sensors.MountedSensor
PLANT = "plant"
NAVIGATION = "navigation"
DISTURBANCE_OBSERVER = "disturbance_observer"
MOTION_PLANNER = "motion_planner"
CONTROLLER = "controller"
THRUST_ALLOCATOR = "thrust_allocator"
"""Names of the nodes, which are the roles of the graph."""

CLOCK = Topic("/clock", "rosgraph_msgs/msg/Clock", int)
IMU, DVL, PRESSURE, GPS = (sensor.topic for sensor in sensors.BUILT_IN)
IMU_FRAME, DVL_FRAME, PRESSURE_FRAME, GPS_FRAME = (
    sensor.mounting_frame for sensor in sensors.BUILT_IN
)
JOINT_STATES = Topic("joint_states", "sensor_msgs/msg/JointState", signals.JointStates, BODY_FRAME)
ODOMETRY = Topic("odometry", "nav_msgs/msg/Odometry", signals.Odometry, WORLD_FRAME, BODY_FRAME)
REFERENCE = Topic("reference", "uvms_msgs/msg/Reference", signals.Reference, WORLD_FRAME)
DISTURBANCE = Topic("disturbance", "geometry_msgs/msg/WrenchStamped", signals.Wrench, BODY_FRAME)
DISTURBANCE_BUDGET = Topic(
    "disturbance/budget",
    "uvms_msgs/msg/DisturbanceBudget",
    signals.DisturbanceBudget,
    BODY_FRAME,
)
WRENCH_COMMAND = Topic(
    "wrench_command", "geometry_msgs/msg/WrenchStamped", signals.Wrench, BODY_FRAME
)
JOINT_COMMAND = Topic(
    "joint_command", "sensor_msgs/msg/JointState", signals.JointCommand, BODY_FRAME
)
THRUSTER_COMMAND = Topic(
    "thruster_command", "sensor_msgs/msg/JointState", signals.ThrusterCommand, BODY_FRAME
)
WRENCH_ACHIEVED = Topic(
    "wrench_achieved", "geometry_msgs/msg/WrenchStamped", signals.Wrench, BODY_FRAME
)
ALLOCATION = Topic("allocation", "uvms_msgs/msg/Allocation", signals.Allocation, BODY_FRAME)
STABILITY = Topic(
    "control/stability",
    "uvms_msgs/msg/ControlStability",
    signals.Stability,
    BODY_FRAME,
    is_occasional=True,
)
"""Of the controller: for the log alone, and not of every control law."""
APPLIED_THRUST = Topic(
    "applied_thrust", "uvms_msgs/msg/AppliedThrust", signals.AppliedThrust, BODY_FRAME
)
BATTERY_STATE = Topic(
    "battery_state", "sensor_msgs/msg/BatteryState", signals.BatteryState, BODY_FRAME
)
"""Of vehicles whose battery and consumption the vehicle file describes, each `BATTERY_PERIOD_S`."""
BATTERY_PERIOD_S = 1.0
TRUE_ODOMETRY = Topic(
    "ground_truth/odometry", "nav_msgs/msg/Odometry", signals.Odometry, WORLD_FRAME, BODY_FRAME
)
TRUE_JOINT_STATES = Topic(
    "ground_truth/joint_states", "sensor_msgs/msg/JointState", signals.JointStates, BODY_FRAME
)
TRUE_DISTURBANCE = Topic(
    "ground_truth/disturbance",
    "uvms_msgs/msg/DisturbanceBudget",
    signals.DisturbanceBudget,
    BODY_FRAME,
)
TF = Topic(
    "/tf",
    "tf2_msgs/msg/TFMessage",
    signals.Odometry,
    WORLD_FRAME,
    BODY_FRAME,
    conversion=Conversion(motion.tf_to, motion.tf_from),
)
TF_STATIC = Topic("/tf_static", "tf2_msgs/msg/TFMessage", qos=LATCHED)
ROBOT_DESCRIPTION = Topic("robot_description", "std_msgs/msg/String", qos=LATCHED)
DIAGNOSTICS = Topic("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", diagnostics.Status)
ROSOUT = Topic("/rosout", "rcl_interfaces/msg/Log", qos=Qos(transient_local=True))
"""Of every node of ROS, not of the loop alone; recorded where there is a graph."""
COMPANIONS = frozenset({DISTURBANCE_BUDGET, ALLOCATION})
"""They tell more about the disturbance and the achieved wrench: whoever puts a node of their own in
the place of the observer or the allocator may leave them out (`tick_gate.Companion`)."""
SENSOR_GAPS = Topic(
    f"{SENSORS}gaps", "uvms_msgs/msg/SensorGaps", signals.SensorGaps, BODY_FRAME, is_occasional=True
)
"""Of the plant: samples that are missing or late. Nobody needs it who has a real vehicle."""
ODOMETRY_GAPS = Topic(
    f"{ODOMETRY.name}/gaps",
    "uvms_msgs/msg/SensorGaps",
    signals.SensorGaps,
    BODY_FRAME,
    is_occasional=True,
)
"""Of navigation: there is no odometry at this stamp, since it does not know where it is."""
GAPS = (SENSOR_GAPS, ODOMETRY_GAPS)
"""What is missing, so that nobody waits for it in lockstep."""
END_EFFECTOR_TARGET = Topic(
    "end_effector_target",
    "geometry_msgs/msg/PointStamped",
    signals.ToolTarget,
    WORLD_FRAME,
    is_occasional=True,
    conversion=Conversion(target.target_to, target.target_from),
)
"""Of whoever leads the tool by hand or by sight; to the planner, while no goal is active."""
RECORDED = Topic("recorded", "rosgraph_msgs/msg/Clock", int)
"""Of the run, not of the loop: up to here everything is in the log. The plant waits for it."""
ENCODERS = "encoders"
"""The joint encoders, which are no sensor of the body; their samples are the joint states."""


def sampled_topics(vehicle: Vehicle) -> dict[str, Topic]:
    """The topics of which `GAPS` may speak, by the names that it has for them.

    Those of the vehicle's sensors with the encoders, and the odometry.
    """
    mounted = {sensor.name: sensor.topic for sensor in sensors.mounted_sensors(vehicle)}
    return {**mounted, ENCODERS: JOINT_STATES, ODOMETRY.name: ODOMETRY}


def _all(kinds: Iterable[Sampled], battery: bool = True) -> tuple[Topic, ...]:
    return (
        CLOCK,
        *(sensor.topic for sensor in kinds),
        JOINT_STATES,
        ODOMETRY,
        REFERENCE,
        DISTURBANCE,
        DISTURBANCE_BUDGET,
        WRENCH_COMMAND,
        JOINT_COMMAND,
        THRUSTER_COMMAND,
        WRENCH_ACHIEVED,
        ALLOCATION,
        STABILITY,
        APPLIED_THRUST,
        *_battery(battery),
        TRUE_ODOMETRY,
        TRUE_JOINT_STATES,
        TRUE_DISTURBANCE,
        TF,
        TF_STATIC,
        ROBOT_DESCRIPTION,
        DIAGNOSTICS,
    )


def _battery(battery: bool) -> tuple[Topic, ...]:
    return (BATTERY_STATE,) if battery else ()


def of(vehicle: Vehicle) -> tuple[Topic, ...]:
    """Every topic of a run with this vehicle, its further sensors' included."""
    return _all(sensors.mounted_sensors(vehicle), vehicle.battery is not None)


ALL = _all(sensors.BUILT_IN)
BY_NAME: dict[str, Topic] = {topic.name: topic for topic in ALL}


FOLLOW_END_EFFECTOR_PATH = Action(
    "follow_end_effector_path", "uvms_msgs/action/FollowEndEffectorPath", signals.PathGoal
)
FOLLOW_JOINT_TRAJECTORY = Action(
    "follow_joint_trajectory", "uvms_msgs/action/FollowJointTrajectory", signals.JointGoal
)
GO_TO_POSE = Action("go_to_pose", "uvms_msgs/action/GoToPose", signals.PoseGoal)
ACTIONS: tuple[Action, ...] = (FOLLOW_END_EFFECTOR_PATH, FOLLOW_JOINT_TRAJECTORY, GO_TO_POSE)


def action_of(goal: signals.Goal) -> Action:
    """The action that takes a goal."""
    return next(action for action in ACTIONS if isinstance(goal, action.goal))


def _nodes(kinds: Iterable[Sampled], battery: bool = True) -> dict[str, NodeTopics]:
    kinds = tuple(kinds)
    measured = tuple(sensor.topic for sensor in kinds)
    fused = tuple(sensor.topic for sensor in kinds if sensor.navigation)
    truth = (APPLIED_THRUST, TRUE_ODOMETRY, TRUE_JOINT_STATES, TRUE_DISTURBANCE)
    return {
        PLANT: NodeTopics(
            (THRUSTER_COMMAND, JOINT_COMMAND),
            (CLOCK, *measured, JOINT_STATES, *_battery(battery), *truth),
        ),
        NAVIGATION: NodeTopics((CLOCK, *fused, ALLOCATION), (ODOMETRY,)),
        DISTURBANCE_OBSERVER: NodeTopics(
            (CLOCK, ODOMETRY, JOINT_STATES, WRENCH_ACHIEVED, ALLOCATION),
            (DISTURBANCE, DISTURBANCE_BUDGET),
        ),
        MOTION_PLANNER: NodeTopics(
            (CLOCK, ODOMETRY, JOINT_STATES, DISTURBANCE_BUDGET), (REFERENCE,), ACTIONS
        ),
        CONTROLLER: NodeTopics(
            (
                CLOCK,
                ODOMETRY,
                JOINT_STATES,
                REFERENCE,
                DISTURBANCE,
                DISTURBANCE_BUDGET,
                ALLOCATION,
            ),
            (WRENCH_COMMAND, JOINT_COMMAND, STABILITY),
        ),
        THRUST_ALLOCATOR: NodeTopics(
            (CLOCK, WRENCH_COMMAND, DISTURBANCE_BUDGET),
            (THRUSTER_COMMAND, WRENCH_ACHIEVED, ALLOCATION),
        ),
    }


def nodes(vehicle: Vehicle) -> dict[str, NodeTopics]:
    """What the nodes read and write in a run with this vehicle."""
    return _nodes(sensors.mounted_sensors(vehicle), vehicle.battery is not None)


NODES = _nodes(sensors.BUILT_IN)


def readers(topic: Topic, graph: Mapping[str, NodeTopics] = NODES) -> set[str]:
    """Names of the nodes that read a topic."""
    return {name for name, own in graph.items() if topic in own.inputs}


def contract(name: str, graph: Mapping[str, NodeTopics] = NODES, namespace: str = "") -> str:
    """Interface of the node of a name under a namespace, as text for whoever replaces it."""
    own = graph[name]
    rows: list[tuple[str, Topic | Action]] = [("reads", topic) for topic in own.inputs]
    rows += [("writes", topic) for topic in own.outputs]
    rows += [("serves", action) for action in own.actions]
    return "\n".join(f"  {verb:6} {each.resolve(namespace)} [{each.type}]" for verb, each in rows)
