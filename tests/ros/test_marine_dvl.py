"""marine_acoustic_msgs/Dvl on real DDS: where its package is sourced, and where it is not."""

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest
from graph import column, finished, own_domain, uvms, uvms_here

from uvms_core import topics
from uvms_core.vehicle import dump_vehicle, load_vehicle

SOURCE = Path(__file__).with_name("marine_acoustic_msgs")
MARINE = "marine_acoustic_msgs/msg/Dvl"
MESSAGE = f"vehicle.sensors.dvl.message={MARINE}"
RUN = ("hover", "--duration", "4", "--seed", "2")
BIN = Path(sys.prefix) / "bin"


def built(folder):
    """A prefix with the package, built as a workspace would be."""
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}
    environment |= dict.fromkeys(("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH"), sys.prefix)
    options = ["-DBUILD_TESTING=OFF", "-DCMAKE_C_FLAGS=-O0", "-DCMAKE_CXX_FLAGS=-O0"]
    options += [f"-DCMAKE_INSTALL_PREFIX={folder / 'install'}"]
    options += [f"-DPython3_EXECUTABLE={sys.executable}"]
    build = folder / "build"
    for command in (
        ["cmake", "-S", SOURCE, "-B", build, "-G", "Ninja", *options],
        ["cmake", "--build", build],
        ["cmake", "--install", build],
    ):
        done = subprocess.run(
            list(map(str, command)), env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return folder / "install"


@pytest.fixture
def sourced(tmp_path, monkeypatch):
    """The package in the environment, as after `source install/setup.bash`."""
    prefix = built(tmp_path)
    python = Path(sysconfig.get_path("purelib")).relative_to(sys.prefix)
    for name, first in (
        ("AMENT_PREFIX_PATH", prefix),
        ("PYTHONPATH", prefix / python),
        ("LD_LIBRARY_PATH", prefix / "lib"),
    ):
        monkeypatch.setenv(name, os.pathsep.join([str(first), os.environ.get(name, "")]))


def test_a_graph_with_the_message_is_that_with_a_twist(sourced, tmp_path):
    """Published, read and recorded by our nodes in the message that a driver would use."""
    marine = finished(uvms(tmp_path / "marine", "run", *RUN, "--composed", "--set", MESSAGE))
    twist = finished(uvms_here(tmp_path / "twist", "simulate", *RUN))
    assert marine.log.topics["/sensors/dvl"] == MARINE
    assert twist.log.topics["/sensors/dvl"] != MARINE
    for name in ("position", "pose_covariance"):
        ours = column(marine.log, topics.ODOMETRY, name)
        np.testing.assert_array_equal(ours, column(twist.log, topics.ODOMETRY, name))


def test_without_the_package_node_and_simulation_say_what_to_source(tmp_path):
    text = f"error: {MARINE} is not installed: source the ROS workspace that has marine_acoustic"
    path = tmp_path / "vehicle.yaml"
    path.write_text(dump_vehicle(load_vehicle(overrides={"sensors.dvl.message": MARINE})))
    command = [BIN / "navigation", "--ros-args", "-p", f"vehicle_file:={path}"]
    node = subprocess.run(command, env=own_domain(), capture_output=True, text=True, timeout=120)
    assert node.returncode == 2
    assert text in node.stderr
    outcome = uvms_here(tmp_path / "simulate", "simulate", *RUN, "--set", MESSAGE)
    assert outcome.code == 2
    assert text in outcome.err
