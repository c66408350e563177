"""Every topic of the system, once: name, type, signal, frame, quality of service.

Nodes, recorder, in-process simulation and report all take names and types from here. Names are
relative, so that they fall under the vehicle's namespace; /clock, /tf, /tf_static and /diagnostics
are global, as everywhere in ROS. docs/signals.md is the readable form of this table.
"""

from dataclasses import dataclass

from uvms_core import diagnostics, signals

Kind = type
"""The class of a signal; `Topic` has a field named `type`."""

WORLD_FRAME = "map_ned"
BODY_FRAME = "base_link_fsd"
IMU_FRAME = "imu_link_fsd"
DVL_FRAME = "dvl_link_fsd"
PRESSURE_FRAME = "pressure_link_fsd"
GPS_FRAME = "gps_link_fsd"


@dataclass(frozen=True)
class Qos:
    """Quality of service; every topic is reliable, so that a lockstep run is repeatable.

    The depth is generous because a writer that overruns its history loses samples even when
    reliable, and in lockstep the plant runs many times faster than the clock on the wall.
    """

    depth: int = 1000
    transient_local: bool = False


LATCHED = Qos(depth=1, transient_local=True)


@dataclass(frozen=True)
class Topic:
    """One topic; `signal` is the dataclass it carries, None where it has none."""

    name: str
    type: str
    signal: Kind | None = None
    frame: str = ""
    child_frame: str = ""
    qos: Qos = Qos()

    @property
    def is_global(self) -> bool:
        """Whether the name does not fall under the vehicle's namespace."""
        return self.name.startswith("/")

    def resolve(self, namespace: str = "") -> str:
        """The full name under a namespace ("" is the root)."""
        if self.is_global:
            return self.name
        return "/" + "/".join(part for part in (namespace.strip("/"), self.name) if part)


CLOCK = Topic("/clock", "rosgraph_msgs/msg/Clock", int)
IMU = Topic("sensors/imu", "sensor_msgs/msg/Imu", signals.ImuSample, IMU_FRAME)
DVL = Topic(
    "sensors/dvl", "geometry_msgs/msg/TwistWithCovarianceStamped", signals.DvlSample, DVL_FRAME
)
PRESSURE = Topic(
    "sensors/pressure", "sensor_msgs/msg/FluidPressure", signals.PressureSample, PRESSURE_FRAME
)
GPS = Topic("sensors/gps", "sensor_msgs/msg/NavSatFix", signals.GpsSample, GPS_FRAME)
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
TF = Topic("/tf", "tf2_msgs/msg/TFMessage", signals.Odometry, WORLD_FRAME, BODY_FRAME)
TF_STATIC = Topic("/tf_static", "tf2_msgs/msg/TFMessage", qos=LATCHED)
ROBOT_DESCRIPTION = Topic("robot_description", "std_msgs/msg/String", qos=LATCHED)
DIAGNOSTICS = Topic("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", diagnostics.Status)

ALL: tuple[Topic, ...] = (
    CLOCK,
    IMU,
    DVL,
    PRESSURE,
    GPS,
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
    TRUE_ODOMETRY,
    TRUE_JOINT_STATES,
    TRUE_DISTURBANCE,
    TF,
    TF_STATIC,
    ROBOT_DESCRIPTION,
    DIAGNOSTICS,
)
BY_NAME: dict[str, Topic] = {topic.name: topic for topic in ALL}


@dataclass(frozen=True)
class Action:
    """An action of the planner; `goal` is the dataclass its goal carries."""

    name: str
    type: str
    goal: Kind


FOLLOW_END_EFFECTOR_PATH = Action(
    "follow_end_effector_path", "uvms_msgs/action/FollowEndEffectorPath", signals.PathGoal
)
FOLLOW_JOINT_TRAJECTORY = Action(
    "follow_joint_trajectory", "uvms_msgs/action/FollowJointTrajectory", signals.JointGoal
)
ACTIONS: tuple[Action, ...] = (FOLLOW_END_EFFECTOR_PATH, FOLLOW_JOINT_TRAJECTORY)


@dataclass(frozen=True)
class NodeTopics:
    """What the node of one name reads and writes, whoever wrote it."""

    inputs: tuple[Topic, ...]
    outputs: tuple[Topic, ...]
    actions: tuple[Action, ...] = ()  # that it serves


NODES: dict[str, NodeTopics] = {
    "plant": NodeTopics(
        (THRUSTER_COMMAND, JOINT_COMMAND),
        (CLOCK, IMU, DVL, PRESSURE, GPS, JOINT_STATES)
        + (TRUE_ODOMETRY, TRUE_JOINT_STATES, TRUE_DISTURBANCE),
    ),
    "navigation": NodeTopics((CLOCK, IMU, DVL, PRESSURE, GPS), (ODOMETRY,)),
    "disturbance_observer": NodeTopics(
        (CLOCK, ODOMETRY, JOINT_STATES, WRENCH_ACHIEVED),
        (DISTURBANCE, DISTURBANCE_BUDGET),
    ),
    "motion_planner": NodeTopics((CLOCK, ODOMETRY, JOINT_STATES), (REFERENCE,), ACTIONS),
    "controller": NodeTopics(
        (CLOCK, ODOMETRY, JOINT_STATES, REFERENCE, DISTURBANCE),
        (WRENCH_COMMAND, JOINT_COMMAND),
    ),
    "thrust_allocator": NodeTopics(
        (CLOCK, WRENCH_COMMAND),
        (THRUSTER_COMMAND, WRENCH_ACHIEVED, ALLOCATION),
    ),
}


def readers(topic: Topic) -> set[str]:
    """Names of the nodes that read a topic."""
    return {name for name, own in NODES.items() if topic in own.inputs}


def contract(name: str) -> str:
    """Interface of the node of a name, as text for whoever replaces it."""
    own = NODES[name]
    rows: list[tuple[str, Topic | Action]] = [("reads", topic) for topic in own.inputs]
    rows += [("writes", topic) for topic in own.outputs]
    rows += [("serves", action) for action in own.actions]
    return "\n".join(f"  {verb:6} {each.name} [{each.type}]" for verb, each in rows)
