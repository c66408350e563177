"""A graph on real DDS that was started by hand: nodes killed, bad messages, a plant restarted."""

import subprocess
import sys
import time

import numpy as np
import pytest
from bad_messages import random_bytes, structured
from hand_started import hand_started

from uvms_core import diagnostics, topics
from uvms_core.vehicle import load_vehicle

VEHICLE = load_vehicle()
REJOIN_S = 5.0
OUTPUT = {
    topics.NAVIGATION: topics.ODOMETRY,
    topics.DISTURBANCE_OBSERVER: topics.DISTURBANCE,
    topics.MOTION_PLANNER: topics.REFERENCE,
    topics.CONTROLLER: topics.WRENCH_COMMAND,
    topics.THRUST_ALLOCATOR: topics.THRUSTER_COMMAND,
}


@pytest.mark.long
def test_any_node_that_is_killed_rejoins_and_works(tmp_path, saw):
    worst = 0.0
    with hand_started(tmp_path) as graph:
        graph.listen(3.0)
        for role, topic in OUTPUT.items():
            graph.kill(role)
            graph.listen(2.0)
            more = {"checkpoint_file": str(tmp_path / "estimate.json")}
            began = graph.start(role, **(more if role == topics.NAVIGATION else {}))
            graph.until(lambda t=topic, b=began: graph.ear.since(t, b), 30.0)
            graph.until(lambda b=began: graph.moves(max(b, time.monotonic() - 1.0)), 30.0)
            worst = max(worst, time.monotonic() - began)
            graph.listen(1.0)
            truth = graph.ear.heard[topics.TRUE_ODOMETRY.name][-1][1]
            estimate = graph.ear.heard[topics.ODOMETRY.name][-1][1]
            assert np.linalg.norm(truth.position - estimate.position) < 2.0, role
            assert graph.alive()
        assert not graph.ear.invalid
    assert worst < REJOIN_S + 1.0  # a second of it is the second that must have been good
    saw("each node killed for 2 s on real DDS", f"all rejoin and work within {worst:.1f} s", "5")


@pytest.mark.long
def test_a_plant_that_is_started_again_resets_the_graph(tmp_path, saw):
    with hand_started(tmp_path) as graph:
        graph.listen(5.0)
        graph.kill(topics.PLANT)
        graph.listen(1.0)
        graph.start(topics.PLANT)
        graph.until(lambda: _begins_anew(graph), 60.0)
        again = time.monotonic()
        took = graph.until(lambda: graph.moves(again), 20.0)
        assert not graph.ear.invalid
        said = [
            s for _, s in graph.ear.heard[topics.DIAGNOSTICS.name] if "time went back" in s.message
        ]
        assert {s.name for s in said if s.level == diagnostics.WARN} == set(OUTPUT)
    assert took < 2.5
    saw("plant killed and started again on real DDS", f"all reset; works {took:.1f} s later")


def _begins_anew(graph):
    return graph.ear.heard[topics.CLOCK.name][-1][1] < 2_000_000_000


@pytest.mark.long
def test_bad_messages_on_real_dds(tmp_path, saw):
    rng = np.random.default_rng(3)
    read = {t for own in topics.NODES.values() for t in own.inputs} - {topics.CLOCK}
    with hand_started(tmp_path) as graph:
        graph.listen(2.0)
        good = dict(graph.ear.last)
        for topic in sorted(read, key=lambda t: t.name):
            by_thruster = topic is topics.THRUSTER_COMMAND
            names = VEHICLE.thruster_names if by_thruster else VEHICLE.joint_names
            for _ in range(50):
                graph.ear.say(topic, random_bytes(rng, good[topic.name]))
                graph.ear.say(topic, structured(rng, topic, good[topic.name], names))
                graph.spinner.spin_once(0.005)
        over = time.monotonic()
        graph.listen(2.0)
        assert graph.alive()
        took = graph.until(lambda: graph.moves(over + 1.0), 2.0)
    saw(
        "bad messages on every topic, real DDS",
        f"no process died; all work {2.0 + took:.1f} s later",
        str(100 * len(read)),
    )


@pytest.mark.long
def test_a_remapped_topic_is_named(tmp_path, saw):
    with hand_started(tmp_path) as graph:
        graph.kill(topics.CONTROLLER)
        command = [sys.executable, "-m", "uvms_core.ros.main", "controller", "--ros-args"]
        command += ["-p", "pace:=realtime", "-r", "odometry:=odom"]
        graph.processes["controller"] = subprocess.Popen(command, env=graph.environment)
        graph.listen(14.0)
        said = [s for _, s in graph.ear.heard[topics.DIAGNOSTICS.name] if s.name == "controller"]
    assert "/odom (nothing yet, nobody publishes it)" in said[-1].message
    assert said[-1].level == diagnostics.WARN
    saw("controller with odometry remapped", "says on /diagnostics: " + said[-1].message[:60])
