"""The external package on the graph: its law in our node, and its own node on plain rclpy."""

from functools import partial

import numpy as np
import pytest
from example_package import installed, uvms
from graph import finished
from graph import uvms as on_the_graph
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.parameter import Parameter

from uvms_analysis.log.read import RunLog
from uvms_control import ControlConfig
from uvms_control.nodes.controller import ControllerNode
from uvms_core import topics
from uvms_core.config import Config
from uvms_core.errors import UvmsError
from uvms_core.ros.main import help_text
from uvms_core.ros.parameters import flatten
from uvms_core.signals import JointStates, Odometry, Reference
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, restoring_wrench

SETTINGS = ("--set", "control.law=my_law", "--set", "control.parameters.bandwidth=0.9")
SCENARIO = ("arm_swing", "--duration", "3")
VEHICLE = load_vehicle()


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return installed(tmp_path_factory.mktemp("my_package"))


@pytest.fixture
def _found(site, monkeypatch):
    """The package in this process and in those that it starts."""
    monkeypatch.syspath_prepend(site)
    monkeypatch.setenv("PYTHONPATH", str(site))


@pytest.fixture(scope="module")
def in_process(site, tmp_path_factory):
    """Log of the run without ROS."""
    folder = tmp_path_factory.mktemp("in_process")
    done = uvms(site, "simulate", *SCENARIO, *SETTINGS, "--output", str(folder))
    assert done.returncode == 0, done.stderr
    return RunLog.open(folder / "run.mcap")


@pytest.mark.parametrize("processes", [("--composed",), ()], ids=["composed", "separate"])
@pytest.mark.usefixtures("_found")
def test_the_law_gives_the_same_commands_on_the_graph(processes, in_process, tmp_path):
    outcome = finished(on_the_graph(tmp_path, "run", *SCENARIO, *SETTINGS, *processes))
    assert outcome.summary["completed"] is True
    for topic, field in ((topics.WRENCH_COMMAND, "wrench"), (topics.JOINT_COMMAND, "effort")):
        ours, own = outcome.log.series(topic), in_process.series(topic)
        np.testing.assert_array_equal(ours.stamps, own.stamps)
        np.testing.assert_allclose(getattr(ours, field), getattr(own, field), atol=1e-12)


@pytest.mark.usefixtures("_found")
def test_a_law_s_parameters_are_ros_parameters_with_type_bounds_and_meaning():
    config = ControlConfig(
        law="my_package.my_law:MyLaw", parameters={"bandwidth": 2, "damping_ratio": 0.7}
    ).resolved()
    assert flatten(config)["parameters.bandwidth"] == 2.0
    overrides = [Parameter(name, value=value) for name, value in flatten(config).items()]
    with graph_of(lambda: ControllerNode(parameter_overrides=overrides)) as (_, (node,)):
        assert node.get_parameter("law").value == "my_package.my_law:MyLaw"
        assert node.get_parameter("parameters.damping_ratio").value == 0.7
        assert node.get_parameter("parameters.arm_bandwidth").value == 6.0
        descriptor = node.describe_parameter("parameters.bandwidth")
        assert descriptor.type == Parameter.Type.DOUBLE.value
        assert descriptor.description == "of the vehicle's axes, rad/s"
        assert not node.has_parameter("parameters")


@pytest.mark.usefixtures("_found")
@pytest.mark.parametrize(
    ("law", "message"),
    [("pid", "'pid' is unknown"), ("my_package.my_node:MyController", "has no method step")],
)
def test_a_node_refuses_a_law_that_does_not_fit(law, message):
    def make() -> ControllerNode:
        return ControllerNode(parameter_overrides=parameters(law=law))

    with pytest.raises(UvmsError, match=message), graph_of(make):
        pass


def test_help_lists_the_choice_and_where_parameters_go():
    text = help_text(ControllerNode)
    assert "law (default)" in text
    assert "parameters.NAME" in text
    assert issubclass(ControlConfig, Config)


@pytest.mark.usefixtures("_found")
def test_the_node_on_plain_rclpy_answers_every_odometry_in_lockstep():
    from my_package.my_node import INPUTS, OUTPUTS, MyController

    def make() -> MyController:
        return MyController(parameter_overrides=parameters(bandwidth=1.0))

    stamps = [0, 50_000_000, 100_000_000]
    with graph_of(make, lambda: Peer(OUTPUTS, INPUTS)) as (spinner, (node, peer)):
        wrenches = peer.heard[topics.WRENCH_COMMAND.name]
        efforts = peer.heard[topics.JOINT_COMMAND.name]
        spin_until(spinner, lambda: all(node.count_publishers(t.name) for t in INPUTS))
        spin_until(spinner, lambda: all(node.count_subscribers(t.name) for t in OUTPUTS))
        peer.say(topics.REFERENCE, reference(), VEHICLE.joint_names)
        for stamp in stamps:  # in lockstep the next tick begins when this one is answered
            peer.say(topics.ODOMETRY, odometry(stamp))
            peer.say(topics.JOINT_STATES, joints(stamp), VEHICLE.joint_names)
            spin_until(spinner, partial(answered, wrenches, efforts, stamp))
    assert [signal.stamp for signal in wrenches] == stamps
    assert [signal.stamp for signal in efforts] == stamps
    at_rest = restoring_wrench(build_model(VEHICLE), LEVEL, stowed())
    for wrench in wrenches:  # on the reference only the weight in water is left to carry
        np.testing.assert_allclose(wrench.wrench, -at_rest, atol=1e-9)


LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
POSITION = np.array([0.0, 0.0, 10.0])


def answered(wrenches: list, efforts: list, stamp: int) -> bool:
    return all(heard and heard[-1].stamp == stamp for heard in (wrenches, efforts))


def stowed() -> np.ndarray:
    return np.radians(np.array(VEHICLE.arm.stowed_deg))


def odometry(stamp: int) -> Odometry:
    return Odometry(stamp, POSITION, LEVEL, np.zeros(6), np.eye(6), np.eye(6))


def joints(stamp: int) -> JointStates:
    still = np.zeros(VEHICLE.n_joints)
    return JointStates(stamp, stowed(), still, still)


def reference() -> Reference:
    times = np.array([0.0, 0.5])
    still = np.zeros((2, VEHICLE.n_joints))
    return Reference(
        stamp=0,
        times=times,
        position=np.tile(POSITION, (2, 1)),
        quaternion=np.tile(LEVEL, (2, 1)),
        nu=np.zeros((2, 6)),
        nu_dot=np.zeros((2, 6)),
        q=np.tile(stowed(), (2, 1)),
        q_dot=still,
        q_ddot=still,
        end_effector=np.zeros((2, 3)),
    )
