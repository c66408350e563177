"""Nodes of somebody else's in the graph: in the place of ours, started by hand, or missing."""

import subprocess
import sys
import time

import pytest
from graph import Outcome, finished, own_domain, uvms
from in_process import graph_of, spin_until
from rclpy.node import Node

from uvms_control.nodes.controller import ControllerNode
from uvms_control.nodes.thrust_allocator import ThrustAllocatorNode
from uvms_core import topics
from uvms_core.ros.roll_call import RollCall
from uvms_dynamics.nodes.plant import PlantNode

MINE = '''
import rclpy
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from sensor_msgs.msg import JointState


class Pusher(Node):
    """A plain node: knows nothing of ours, reads no disturbance, pushes the vehicle down."""

    def __init__(self, **options):
        super().__init__("pusher", **options)
        self.names = []
        self.wrench = self.create_publisher(WrenchStamped, "wrench_command", 1000)
        self.torque = self.create_publisher(JointState, "joint_command", 1000)
        self.create_subscription(JointState, "joint_states", self.keep_names, 1000)
        self.create_subscription(Odometry, "odometry", self.push, 1000)

    def keep_names(self, msg):
        self.names = msg.name

    def push(self, msg):
        wrench = WrenchStamped()
        wrench.header.stamp, wrench.header.frame_id = msg.header.stamp, "base_link_fsd"
        wrench.wrench.force.z = 7.0
        self.wrench.publish(wrench)
        names = self.names or ["swing", "shoulder", "elbow", "wrist"]
        torque = JointState(header=wrench.header, name=names, effort=[0.0] * len(names))
        self.torque.publish(torque)


if __name__ == "__main__":
    rclpy.init()
    rclpy.spin(Pusher())
'''


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A module `mine` with a node, importable by every process of the test."""
    (tmp_path / "mine.py").write_text(MINE, encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    return tmp_path / "mine.py"


def pushed(outcome: Outcome) -> bool:
    """Whether the log holds the wrench that only `Pusher` commands."""
    wrenches = finished(outcome).log.series(topics.WRENCH_COMMAND).wrench
    return len(wrenches) == 21 and (wrenches[:, 2] == 7.0).all()


@pytest.mark.parametrize("how", [[], ["--composed"]], ids=["processes", "composed"])
def test_a_plain_node_takes_the_place_of_the_controller(mine, tmp_path, how):
    options = ["--duration", "1", "--node", "controller=mine:Pusher", "--namespace", "rov"]
    outcome = uvms(tmp_path / "run", "run", "hover", *options, *how)
    assert pushed(outcome)
    assert outcome.log.namespace == "rov"
    assert outcome.summary["completed"]


def test_a_run_waits_for_the_node_that_is_left_to_the_user_and_names_it(mine, tmp_path):
    environment = own_domain()
    command = [sys.executable, "-m", "uvms_bringup.cli", "run", "hover", "--duration", "1"]
    command += ["--without", "controller", "--without", "disturbance_observer"]
    command += ["--output", str(tmp_path / "run")]
    with (tmp_path / "err").open("w") as err:
        run = subprocess.Popen(
            command, env=environment, stdout=subprocess.PIPE, stderr=err, text=True
        )
    try:
        while "waiting for" not in (tmp_path / "err").read_text():
            assert run.poll() is None
            time.sleep(0.2)
        user = subprocess.Popen([sys.executable, str(mine)], env=environment)
        try:
            out, _ = run.communicate(timeout=120.0)
        finally:
            user.kill()
            user.wait()
    finally:
        run.kill()
    assert pushed(Outcome(run.returncode, out, "", tmp_path / "run"))
    assert "controller is left to you; it\n  reads  /clock [rosgraph_msgs/msg/Clock]\n" in out
    assert "\n  writes /wrench_command [geometry_msgs/msg/WrenchStamped]\n" in out
    waited = (tmp_path / "err").read_text()
    assert (
        "controller: nobody publishes 'wrench_command' (geometry_msgs/msg/WrenchStamped)" in waited
    )
    assert "disturbance_observer" not in waited  # nobody who is there would read its topics


def test_a_node_that_cannot_be_a_node_is_refused(mine, tmp_path):
    wrong = uvms(tmp_path / "a", "run", "hover", "--node", "controller=mine:rclpy")
    assert wrong.code == 2
    assert "mine:rclpy: is no subclass of rclpy.node.Node" in wrong.err
    missing = uvms(tmp_path / "b", "run", "hover", "--node", "controller=mine:Pilot")
    assert missing.code == 2
    assert "cannot import mine:Pilot" in missing.err


def test_the_plant_of_a_graph_started_by_hand_logs_what_is_missing(monkeypatch):
    """Without an observer the controller is not ready, and the plant says of whom it knows that."""
    from uvms_dynamics.nodes import plant as module

    monkeypatch.setattr(module, "NOTICE", 0.3)
    with graph_of(PlantNode, ThrustAllocatorNode, ControllerNode) as (spinner, (plant, *_)):
        lines: list[str] = []
        monkeypatch.setattr(plant.get_logger(), "info", lines.append)
        wanted = "controller: nobody publishes 'odometry' (nav_msgs/msg/Odometry)"
        spin_until(spinner, lambda: any(wanted in line for line in lines))
        assert not plant._running
        missing = lines[-1].splitlines()
    assert any(line.startswith("  navigation: nobody publishes 'odometry'") for line in missing)


def test_a_role_without_our_service_counts_as_soon_as_it_publishes_what_others_read():
    def pilot() -> Node:
        return Node("pilot")

    with graph_of(pilot, ThrustAllocatorNode, lambda: Node("asker")) as (spinner, nodes):
        pilot_node, _, asker = nodes
        roll_call = RollCall(asker, ("controller", "thrust_allocator"), foreign=None)
        spin_until(spinner, lambda: "thrust_allocator" not in roll_call.foreign)
        spin_until(spinner, lambda: "wrench_command" in roll_call.poll().get("controller", ""))
        from uvms_core.ros.convert import message_class
        from uvms_core.ros.subscribe import qos_profile

        for topic in (topics.WRENCH_COMMAND, topics.JOINT_COMMAND):
            kind, qos = message_class(topic), qos_profile(topic.qos)
            pilot_node.create_publisher(kind, topic.name, qos)
        spin_until(spinner, lambda: "controller" not in roll_call.poll())
        assert "controller" in roll_call.foreign
