"""Runs do not mix: each knows its own, and notices whoever does not belong."""

import os
import signal
import subprocess
import sys

import pytest
from live import children, gone, no_domain, one_domain, running

HOVER = ("run", "hover", "--composed", "--duration")
UNHURRIED = ("600", "--pace", "realtime")
"""A run that is only there, and leaves the processor to the other one."""


def test_a_second_run_on_a_domain_is_refused_and_names_the_first(tmp_path, saw):
    domain = one_domain()
    with running(tmp_path / "a", *HOVER, *UNHURRIED, **domain) as first:
        first.await_ticks()
        with running(tmp_path / "b", *HOVER, "5", **domain) as second:
            assert second.code() == 2
        assert f"ROS_DOMAIN_ID={domain['ROS_DOMAIN_ID']} is in use by run " in second.text
        assert f"(process {first.process.pid}: uvms run hover" in second.text
        assert first.process.poll() is None
    saw("a second run on a ROS domain", "refused with exit 2 before it starts, names the first")


@pytest.mark.long
def test_two_runs_that_start_at_once_without_a_domain_find_one_each(tmp_path, saw):
    with running(tmp_path / "a", *HOVER, "5", "--seed", "1", **no_domain()) as first:
        with running(tmp_path / "b", *HOVER, "5", "--seed", "2", **no_domain()) as second:
            assert (first.code(), second.code()) == (0, 0), first.text + second.text
    assert first.text.split("ROS_DOMAIN_ID=")[1] != second.text.split("ROS_DOMAIN_ID=")[1]
    assert first.summary["run_id"] != second.summary["run_id"]
    assert first.summary["vehicle_error_m"] != second.summary["vehicle_error_m"]
    saw("two runs at the same moment, no domain given", "each finds its own, results differ")


def test_a_graph_that_knows_nothing_of_locks_is_seen_before_the_start(tmp_path, saw):
    domain = one_domain()
    other = tmp_path / "elsewhere"  # as on another machine
    other.mkdir()
    with running(tmp_path / "a", *HOVER, *UNHURRIED, **domain) as first:
        first.await_ticks()
        with running(tmp_path / "b", *HOVER, "5", TMPDIR=str(other), **domain) as second:
            assert second.code() == 2
        assert f"ROS_DOMAIN_ID={domain['ROS_DOMAIN_ID']} is occupied: " in second.text
        assert "/plant" in second.text
        assert f"process {first.process.pid}: " in second.text
        assert not (tmp_path / "b" / "run.mcap").exists()
    saw("a domain with a graph of another machine", "refused with exit 2, names its nodes")


INTRUDER = """
import sys, time, rclpy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
rclpy.init()
node = rclpy.create_node("intruder")
kind = Clock if sys.argv[1] == "/clock" else JointState
node.create_publisher(kind, sys.argv[1], 10)
time.sleep(60.0)
"""


@pytest.mark.parametrize(
    "topic", ["/clock", pytest.param("thruster_command", marks=pytest.mark.long)]
)
def test_a_foreign_publisher_ends_a_run_that_is_then_invalid(tmp_path, saw, topic):
    domain = one_domain()
    with running(tmp_path / "a", *HOVER, "6000", **domain) as run:
        run.await_ticks()
        intruder = subprocess.Popen(
            [sys.executable, "-c", INTRUDER, topic],
            env=dict(os.environ, ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST", **domain),
        )
        try:
            assert run.code(60.0) == 3, run.text
        finally:
            intruder.kill()
            intruder.wait()
    assert "/intruder" in run.end.foreign[0]
    assert topic.strip("/") in run.end.foreign[0]
    assert run.summary["outcome"] == "invalid"
    assert run.summary["completed"] is False
    saw(f"somebody else publishes {topic} during a run", "ended at once, invalid, exit 3, named")


def test_kill_9_of_the_parent_leaves_no_orphan_and_the_domain_free(tmp_path, saw):
    domain = one_domain()
    with running(tmp_path / "a", "run", "hover", "--duration", "600", **domain) as run:
        run.await_ticks()
        nodes = list(children(run.process.pid).values())
        assert len(nodes) == 6
        run.signal(signal.SIGKILL)
        run.code()
        assert gone(nodes)
    assert run.log.fault  # a log that was cut off says so
    with running(tmp_path / "b", *HOVER, "1", **domain) as following:
        assert following.code() == 0, following.text
    saw("kill -9 of the parent", "its six nodes end with it; the next run on the domain starts")


@pytest.mark.long
def test_kill_9_of_the_parent_while_its_nodes_start_leaves_no_orphan(tmp_path, saw):
    with running(tmp_path / "a", "run", "hover", "--duration", "600") as run:
        run.await_node("plant")
        nodes = list(children(run.process.pid).values())
        run.signal(signal.SIGKILL)
        run.code()
        assert gone(nodes)
    saw("kill -9 of the parent during the start", "no orphan")


def test_two_runs_into_one_folder(tmp_path, saw):
    arguments = ("simulate", "hover", "--duration", "3")
    with running(tmp_path / "a", *arguments, "--seed", "1") as first:
        second_name = tmp_path / "a"
        with running(second_name, *arguments, "--seed", "2") as second:
            codes = sorted((first.code(), second.code()))
    assert codes == [0, 2]
    saw("two runs into one folder at once", "the second is refused with exit 2")
