"""`uvms replay` on real ROS topics and with a real node."""

import subprocess
import sys

import pytest
import yaml
from graph import own_domain

from uvms_analysis.log.compare import compare
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_core import topics
from uvms_core.vehicle import dump_vehicle

REPLAY = "import sys; from uvms_bringup.ros.replay import replay; sys.exit(replay({arguments}))"
LISTENER = """
from rclpy.node import Node
from rclpy.task import Future
from uvms_core import topics
from uvms_core.messages import from_message
from uvms_core.ros.convert import message_class
from uvms_core.ros.subscribe import qos_profile
from uvms_core.ros.spin import Spinner, start

start(["listener"])
node, came = Node("listener"), Future()
stamps = {topics.CLOCK: [], topics.ODOMETRY: []}

def take(topic, msg):
    signal = from_message(topic, msg)
    stamps[topic].append(signal if topic is topics.CLOCK else signal.stamp)
    if all(items and items[-1] >= 2 * 10**9 for items in stamps.values()) and not came.done():
        came.set_result(True)

for topic in stamps:
    node.create_subscription(
        message_class(topic), topic.name, lambda m, t=topic: take(t, m), qos_profile(topic.qos)
    )
spinner = Spinner([node])
print("listening", flush=True)
spinner.spin_for(came, 60.0)
spinner.shutdown()
print([len(items) for items in stamps.values()], flush=True)
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Log of two seconds of hovering."""
    folder = tmp_path_factory.mktemp("run")
    scenario = load_scenario("hover", duration_s=2.0)
    vehicle = scenario.load_vehicle()
    with LogWriter(folder / "run.mcap") as log:
        log.attach("config.yaml", yaml.safe_dump(scenario.model_dump(mode="json")))
        log.attach("vehicle.yaml", dump_vehicle(vehicle))
        log.metadata("uvms", {"scenario": "hover", "seed": 1})
        writer = SignalWriter(log, vehicle.joint_names, vehicle.thruster_names)
        assert simulate(scenario, vehicle, None, writer)
    return folder / "run.mcap"


@pytest.fixture
def surroundings(tmp_path):
    return own_domain() | {"ROS_LOG_DIR": str(tmp_path / "ros")}


def start_replay(arguments, surroundings):
    code = REPLAY.format(arguments=arguments)
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    return subprocess.Popen([sys.executable, "-c", code], env=surroundings, **pipes)


@pytest.mark.parametrize("node", ["thrust_allocator", "controller", "plant"])
def test_a_node_answers_its_recorded_inputs_as_it_did(run, node, tmp_path, surroundings):
    process = start_replay(f"{str(run)!r}, into={node!r}, output={str(tmp_path)!r}", surroundings)
    text, _ = process.communicate(timeout=200)
    assert process.returncode == 0, text
    assert "0 unanswered" in text
    replayed = RunLog.open(tmp_path / "replay.mcap")
    assert replayed.run["replay_into"] == node
    for difference in compare(RunLog.open(run), replayed, topics.NODES[node].outputs):
        assert difference.recorded == difference.replayed == difference.common > 0
        assert difference.greatest < 1e-9, difference


def test_a_log_is_published_with_its_clock(run, surroundings):
    listener = subprocess.Popen(
        [sys.executable, "-c", LISTENER], env=surroundings, stdout=subprocess.PIPE, text=True
    )
    assert listener.stdout.readline() == "listening\n"
    process = start_replay(f"{str(run)!r}, rate=4.0", surroundings)
    text, _ = process.communicate(timeout=100)
    assert process.returncode == 0, text
    told, _ = listener.communicate(timeout=100)
    assert told == "[41, 41]\n"
