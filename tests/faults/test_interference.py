"""What somebody else asks of a run's nodes stands in its log."""

import os
import subprocess
import sys

import pytest
from live import one_domain, running

from uvms_core import topics
from uvms_core.vehicle import load_vehicle

MEDDLER = """
import sys
import rclpy
from rclpy.action import ActionClient
from std_srvs.srv import SetBool
from uvms_core import topics
from uvms_core.messages import to_message
from uvms_core.ros.convert import action_class, to_ros
from uvms_core.signals import JointGoal
import numpy as np

names = sys.argv[1].split(",")
rclpy.init()
node = rclpy.create_node("meddler")

def wait(future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=30.0)
    return future.result()

pause = node.create_client(SetBool, "pause")
assert pause.wait_for_service(30.0)
for hold in (True, False):
    assert wait(pause.call_async(SetBool.Request(data=hold))).success
action = topics.FOLLOW_JOINT_TRAJECTORY
kind = action_class(action)
client = ActionClient(node, kind, action.name)
assert client.wait_for_server(30.0)
goal = JointGoal(np.array([4.0]), np.radians([[5.0, 5.0, 130.0, 0.0]]))
assert wait(client.send_goal_async(to_ros(kind.Goal, to_message(action, goal, names)))).accepted
"""


@pytest.mark.long
def test_a_pause_and_a_goal_of_somebody_else_are_incidents(tmp_path, saw):
    domain = one_domain()
    names = ",".join(load_vehicle().joint_names)
    arguments = ("run", "hover", "--duration", "12", "--pace", "realtime")
    with running(tmp_path / "a", *arguments, **domain) as run:
        run.await_node(topics.PLANT)
        run.await_ticks(40_000)
        environment = os.environ | domain | {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        subprocess.run([sys.executable, "-c", MEDDLER, names], env=environment, check=True)
        run.code()
    incidents = "; ".join(run.end.incidents)
    assert "time was held 1 times" in incidents
    assert run.end.incidents.count("the planner accepted 1 goals that were not this run's") == 1
    assert run.summary["check"]["notes"] or run.summary["incidents"]
    saw("a pause and a goal of somebody else's client", "incidents in log and summary")


@pytest.mark.long
def test_a_run_whose_goal_gives_way_to_somebody_elses_is_not_completed(tmp_path, saw):
    domain = one_domain()
    names = ",".join(load_vehicle().joint_names)
    arguments = ("run", "manipulation", "--duration", "16", "--pace", "realtime")
    with running(tmp_path / "a", *arguments, **domain) as run:
        run.await_node(topics.PLANT)
        run.await_ticks(400_000)  # the path alone takes 100 kB
        environment = os.environ | domain | {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        slower = MEDDLER.replace("[4.0]", "[20.0]")  # from another posture
        subprocess.run([sys.executable, "-c", slower, names], env=environment, check=True)
        run.code()
    incidents = "; ".join(run.end.incidents)
    assert "the planner accepted 1 goals that were not this run's" in incidents
    assert "the run's goal: pre-empted by a new goal" in incidents
    assert run.end.goal == "aborted"
    assert run.summary["outcome"] == "given up"
    assert "the planner's goal was aborted" in run.summary["reasons"]
    saw("somebody else's goal in the place of the run's own", "given up, and the incidents say why")
