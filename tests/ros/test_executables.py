"""The six executables, started by hand as `ros2 run` starts them: they find each other and run."""

import subprocess
import sys
from pathlib import Path

import pytest
from graph import own_domain

from uvms_core import registry, topics

PREFIX = Path(sys.prefix)
EXECUTABLES = [
    PREFIX / "lib" / registry.load(registry.NODES, node).__module__.partition(".")[0] / node
    for node in topics.NODES
]
LISTENER = """
import sys, time, rclpy
from rosgraph_msgs.msg import Clock
rclpy.init()
node = rclpy.create_node("listener")
heard = []
node.create_subscription(Clock, "/clock", lambda msg: heard.append(msg.clock.sec), 1000)
end = time.monotonic() + 240
while time.monotonic() < end and (not heard or heard[-1] < 2):
    rclpy.spin_once(node, timeout_sec=0.2)
sys.exit(0 if heard and heard[-1] >= 2 else 1)
"""


@pytest.mark.parametrize("path", EXECUTABLES, ids=lambda path: path.name)
def test_help_tells_what_a_node_does_and_its_parameters(path):
    done = subprocess.run([path, "--help"], capture_output=True, text=True, check=True, timeout=120)
    assert done.stdout.startswith(f"Node `{path.name}`: ")
    assert "vehicle_file" in done.stdout
    assert "parameters of this node" in done.stdout


def test_nodes_started_by_hand_find_each_other_and_run(tmp_path):
    environment = own_domain() | {"ROS_LOG_DIR": str(tmp_path)}
    nodes = [
        subprocess.Popen([path], env=environment, stderr=subprocess.PIPE, text=True)
        for path in EXECUTABLES
    ]
    try:
        listener = [sys.executable, "-c", LISTENER]
        heard = subprocess.run(listener, env=environment, check=False, timeout=300)
    finally:
        for node in nodes:
            node.terminate()
        said = [node.communicate(timeout=30)[1] for node in nodes]
    assert heard.returncode == 0, said
    assert [node.returncode for node in nodes] == [0] * len(nodes), said
    assert "in time; going on" not in "".join(said)


def test_a_wrong_vehicle_file_ends_a_node_with_a_clear_error(tmp_path):
    command = [EXECUTABLES[0], "--ros-args", "-p", f"vehicle_file:={tmp_path / 'none.yaml'}"]
    done = subprocess.run(command, capture_output=True, text=True, env=own_domain(), check=False)
    assert done.returncode == 2
    assert "none.yaml" in done.stderr
    assert "Traceback" not in done.stderr
