"""The launch file, with a stand-in for the package `launch`, which ROS's wheels lack.

The stand-in records what the file asks for; the nodes are then started as launch_ros starts them.
"""

import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from runpy import run_path
from types import ModuleType

import pytest
from graph import own_domain

from uvms_bringup.pace import Pace
from uvms_bringup.ros.parameter_file import node_parameters, write_parameter_file
from uvms_bringup.scenario import load_scenario
from uvms_core import topics
from uvms_core.vehicle.locate import reference_file

FILE = Path(__file__).parents[2] / "bringup/launch/uvms.launch.py"
LISTENER = """
import sys, time, rclpy
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage
rclpy.init()
node = rclpy.create_node("listener")
heard = set()
def clock(message):
    if message.clock.sec >= 1:
        heard.add("clock")
node.create_subscription(Clock, "/clock", clock, 1000)
node.create_subscription(TFMessage, "/tf", lambda message: heard.add("tf"), 10)
end = time.monotonic() + 240
while time.monotonic() < end and len(heard) < 2:
    rclpy.spin_once(node, timeout_sec=0.2)
spaces = {space for name, space in node.get_node_names_and_namespaces() if name != "listener"}
print(spaces)
sys.exit(0 if len(heard) == 2 and spaces == {"/auv1"} else 1)
"""


@dataclass
class Description:
    entities: list


@dataclass
class Argument:
    name: str
    default_value: str
    description: str


@dataclass
class Function:
    function: object


@dataclass
class Configuration:
    name: str

    def perform(self, context):
        return context[self.name]


@dataclass
class Node:
    package: str
    executable: str
    name: str
    namespace: str
    output: str
    parameters: list = field(default_factory=list)

    @property
    def program(self):
        return Path(sys.prefix) / "lib" / self.package / self.executable

    @property
    def values(self):
        return self.parameters[-1]

    def command(self, folder):
        """As launch_ros does it: names by remapping, dictionaries by a file of parameters."""
        files = [
            *self.parameters[:-1],
            write_parameter_file(folder / f"{self.name}.yaml", self.name, self.values),
        ]
        words = ["--ros-args", "-r", f"__node:={self.name}"]
        words += ["-r", f"__ns:=/{self.namespace}"] if self.namespace else []
        for file in files:
            words += ["--params-file", str(file)]
        return [str(self.program), *words]


@pytest.fixture
def launch(monkeypatch):
    """Runs the launch file with arguments; the nodes that it would start."""
    classes = {
        "launch": {"LaunchDescription": Description},
        "launch.actions": {"DeclareLaunchArgument": Argument, "OpaqueFunction": Function},
        "launch.substitutions": {"LaunchConfiguration": Configuration},
        "launch_ros": {},
        "launch_ros.actions": {"Node": Node},
    }
    for name, members in classes.items():
        module = ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)

    def run(**given):
        *arguments, last = run_path(str(FILE))["generate_launch_description"]().entities
        values = {one.name: one.default_value for one in arguments}
        assert set(given) <= set(values)
        return last.function(values | given)

    return run


def test_it_starts_the_nodes_of_the_graph_and_the_state_publisher(launch):
    nodes = launch()
    assert {node.name for node in nodes} == {*topics.NODES, "state_publisher"}
    assert all(node.program.is_file() for node in nodes)
    assert {node.values["pace"] for node in nodes} == {"lockstep"}
    assert all(len(node.parameters) == 1 for node in nodes)


def test_arguments_go_to_every_node(launch):
    nodes = launch(vehicle_file="bluerov2_alpha5", pace="realtime:2", namespace="auv1")
    assert {node.namespace for node in nodes} == {"auv1"}
    assert {node.values["vehicle_file"] for node in nodes} == {"bluerov2_alpha5"}
    assert {node.values["pace"] for node in nodes} == {"realtime"}
    assert [node.values["realtime_factor"] for node in nodes if node.name == "plant"] == [2.0]


def test_parameters_are_a_file_or_a_folder(launch, tmp_path):
    (tmp_path / "controller.yaml").write_text("")
    of_folder = {node.name: node.parameters[:-1] for node in launch(parameters=str(tmp_path))}
    assert of_folder.pop("controller") == [str(tmp_path / "controller.yaml")]
    assert set(map(len, of_folder.values())) == {0}
    one = str(tmp_path / "controller.yaml")
    assert all(node.parameters[:-1] == [one] for node in launch(parameters=one))


def test_the_launched_graph_runs_with_the_parameters_of_a_scenario(launch, tmp_path):
    scenario = load_scenario("hover")
    for node, own in node_parameters(scenario, reference_file(), Pace()).items():
        write_parameter_file(tmp_path / "parameters" / f"{node}.yaml", node, own)
    environment = own_domain() | {"ROS_LOG_DIR": str(tmp_path)}
    nodes = launch(parameters=str(tmp_path / "parameters"), namespace="auv1")
    running = [
        subprocess.Popen(node.command(tmp_path), env=environment, stderr=subprocess.PIPE, text=True)
        for node in nodes
    ]
    try:
        listener = [sys.executable, "-c", LISTENER]
        heard = subprocess.run(listener, env=environment, check=False, timeout=300)
    finally:
        for process in running:
            process.terminate()
        printed = [process.communicate(timeout=30)[1] for process in running]
    assert heard.returncode == 0, printed
    assert [process.returncode for process in running] == [0] * len(running), printed
