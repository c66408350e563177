"""/tf, /tf_static and robot_description: in every log, at the right stamps, for late viewers."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from graph import Outcome, finished, uvms_here
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.node import Node

from uvms_analysis.log.schema import qos_from_yaml
from uvms_bringup.ros.recorder import Recorder
from uvms_bringup.ros.state_publisher import StatePublisherNode
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.description import static_message, urdf_text
from uvms_core.signals import JointStates, Odometry
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import quat_to_matrix

DURATION = "2"
TICKS = 41
VIEWERS = (topics.TF, topics.TF_STATIC, topics.ROBOT_DESCRIPTION)
VEHICLE = load_vehicle()


def outcome_of(folder, *arguments: str) -> Outcome:
    return finished(uvms_here(folder, *arguments, "manipulation", "--duration", DURATION))


@pytest.fixture(scope="module")
def simulated(tmp_path_factory) -> Outcome:
    return outcome_of(tmp_path_factory.mktemp("simulated"), "simulate")


@pytest.fixture(scope="module")
def composed(tmp_path_factory) -> Outcome:
    return outcome_of(tmp_path_factory.mktemp("composed"), "run", "--composed")


@pytest.fixture(params=["simulated", "composed"])
def log(request):
    return request.getfixturevalue(request.param).log


def raw(log, topic):
    return [(stamp, data) for _, stamp, data in log.raw([log.full_name(topic)])]


def transforms(log):
    """Log stamp and transforms of every /tf."""
    wire = codec(topics.TF.type)
    return [(stamp, wire.decode(data).transforms) for stamp, data in raw(log, topics.TF)]


def stamp_in(header) -> int:
    return header.stamp.sec * 10**9 + header.stamp.nanosec


def pose_of(transform):
    move, turn = transform.transform.translation, transform.transform.rotation
    return np.array([move.x, move.y, move.z]), np.array([turn.x, turn.y, turn.z, turn.w])


def test_tf_is_the_odometry_at_its_stamp(log):
    odometry = {signal.stamp: signal for signal in log.signals(topics.ODOMETRY)}
    found = transforms(log)
    assert [stamp for stamp, _ in found] == [k * 50_000_000 for k in range(TICKS)]
    for stamp, (base, *_) in found:
        position, quaternion = pose_of(base)
        assert (base.header.frame_id, base.child_frame_id) == ("map_ned", "base_link_fsd")
        np.testing.assert_array_equal(position, odometry[stamp].position)
        np.testing.assert_array_equal(quaternion, odometry[stamp].quaternion)


def test_every_transform_has_the_stamp_of_its_message(log):
    for stamp, both in transforms(log):
        assert [stamp_in(one.header) for one in both] == [stamp] * (1 + VEHICLE.n_joints)


def test_the_arm_is_where_the_joint_states_put_it(log):
    model = build_model(VEHICLE)
    joints = {signal.stamp: signal for signal in log.signals(topics.JOINT_STATES)}
    static = codec(topics.TF_STATIC.type).decode(raw(log, topics.TF_STATIC)[0][1])
    tool = next(one for one in static.transforms if one.child_frame_id == "tool")
    for stamp, (base, *links) in transforms(log):
        position, rotation = np.zeros(3), np.eye(3)
        for one in (base, *links, tool):
            move, turn = pose_of(one)
            position, rotation = position + rotation @ move, rotation @ quat_to_matrix(turn)
        expected = end_effector(model, *pose_of(base), joints[stamp].position)
        np.testing.assert_allclose(position, expected[0], atol=1e-12)
        np.testing.assert_allclose(rotation, expected[1], atol=1e-12)


def test_description_and_fixed_frames_come_once_at_the_start_for_late_viewers_too(log):
    for topic, message in (
        (topics.ROBOT_DESCRIPTION, {"data": urdf_text(VEHICLE)}),
        (topics.TF_STATIC, static_message(VEHICLE)),
    ):
        assert raw(log, topic) == [(0, codec(topic.type).encode(message))]
        qos = log.channel(log.full_name(topic))[2]["offered_qos_profiles"]
        assert qos_from_yaml(qos).transient_local


def test_run_and_simulation_say_the_same_byte_for_byte(simulated, composed):
    for topic in VIEWERS:
        assert raw(simulated.log, topic) == raw(composed.log, topic), topic.name


class Viewer(Node):
    """Records what the state publisher gives."""

    def __init__(self) -> None:
        super().__init__("viewer")
        self.came: dict[str, list[tuple[int, bytes]]] = {topic.name: [] for topic in VIEWERS}
        Recorder(self, self._take)

    def _take(self, name: str, _: str, __: str, stamp: int, data: bytes) -> None:
        topic = name if name in self.came else name.removeprefix("/")
        if topic in self.came:
            self.came[topic].append((stamp, data))


@pytest.mark.parametrize("pace", ["lockstep", "realtime"])
def test_the_node_alone_serves_viewers_and_survives_rubbish(pace):
    def node() -> StatePublisherNode:
        return StatePublisherNode(parameter_overrides=parameters(pace=pace))

    def peer() -> Peer:
        return Peer((), (topics.ODOMETRY, topics.JOINT_STATES))

    stamp, q = 7_050_000_000, np.array([0.1, 0.2, 0.3, 0.4])
    turn, none = np.array([0.0, 0.0, 0.6, 0.8]), np.zeros(4)
    position = np.array([1.0, 2.0, 3.0])

    def odometry(position) -> Odometry:
        return Odometry(stamp, position, turn, np.zeros(6), np.eye(6), np.eye(6))

    with graph_of(node, peer, Viewer) as (spinner, (_, other, viewer)):
        spin_until(spinner, lambda: other.count_subscribers("odometry") == 2)
        spin_until(spinner, lambda: other.count_subscribers("joint_states") == 2)
        spin_until(spinner, lambda: viewer.count_publishers("/tf") == 1)
        spin_until(spinner, lambda: viewer.came["/tf_static"] and viewer.came["robot_description"])
        other.say(topics.JOINT_STATES, JointStates(stamp, q, none, none), VEHICLE.joint_names)
        other.say(topics.ODOMETRY, odometry(np.array([np.nan, 0.0, 0.0])))
        other.say(topics.ODOMETRY, odometry(position))
        spin_until(spinner, lambda: viewer.came["/tf"])
        ((when, data),) = viewer.came["/tf"]
    assert when == stamp
    base, *links = codec(topics.TF.type).decode(data).transforms
    np.testing.assert_array_equal(pose_of(base)[0], position)
    np.testing.assert_array_equal(pose_of(base)[1], turn)
    assert [one.child_frame_id for one in links] == [link.name for link in VEHICLE.arm.links]
    robot = ElementTree.fromstring(
        codec(topics.ROBOT_DESCRIPTION.type).decode(viewer.came["robot_description"][0][1]).data
    )
    assert robot.get("name") == VEHICLE.name
