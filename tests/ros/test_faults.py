"""What the nodes do when something is missing, broken or cannot be done."""

import numpy as np
import pytest
from graph import uvms_here
from in_process import Peer, graph_of, parameters, spin_until

from uvms_control.nodes.thrust_allocator import ThrustAllocatorNode
from uvms_core import diagnostics, topics
from uvms_core.errors import ConfigError
from uvms_core.ros.roll_call import nobody_reads
from uvms_core.signals import ThrusterCommand, Wrench
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.nodes.plant import PlantNode

VEHICLE = load_vehicle()
TOO_FAST = """
scenario: too_fast
duration_s: 10.0
plant:
  initial_position_m: [0.0, 0.0, 10.0]
  initial_joints_deg: [0.0, 30.0, 60.0, 0.0]
goal:
  path:
    phases: [{duration_s: 0.2, to_m: [0.5, 0.0, 0.0]}]
"""


def test_the_plant_says_who_is_missing_goes_on_safely_and_marks_the_run():
    def plant() -> PlantNode:
        return PlantNode(
            parameter_overrides=parameters(
                first_timeout_s=0.3, timeout_s=0.3, duration_s=0.1, auto_start=False
            )
        )

    def peer() -> Peer:
        return Peer((topics.DIAGNOSTICS, topics.CLOCK), (topics.THRUSTER_COMMAND,))

    with graph_of(plant, peer) as (spinner, (node, other)):
        spin_until(spinner, lambda: not other_missing(node, "thruster_command"))
        spin_until(spinner, lambda: node.count_subscribers("/clock") >= 1)
        node._start()
        spin_until(spinner, lambda: 0 in other.heard[topics.CLOCK.name])
        thrust = np.zeros(VEHICLE.n_thrusters)
        other.say(topics.THRUSTER_COMMAND, ThrusterCommand(0, thrust), VEHICLE.thruster_names)
        spin_until(spinner, lambda: 100_000_000 in other.heard[topics.CLOCK.name])
        warnings = [s for s in other.heard[topics.DIAGNOSTICS.name] if s.level == diagnostics.WARN]
    assert warnings[0].message == (
        "t = 0.00 s: no joint_command in time; continuing with the safe command"
    )
    assert "no thruster_command and no joint_command" in warnings[1].message
    assert warnings[-1].number("lockstep_timeouts") == 2


def other_missing(node: PlantNode, name: str) -> bool:
    return any(f"publishes {name!r}" in lack for lack in node.missing_peers())


def test_a_node_that_gets_rubbish_reports_it_and_goes_on():
    def peer() -> Peer:
        heard = (topics.DIAGNOSTICS, topics.THRUSTER_COMMAND)
        return Peer(heard, (topics.WRENCH_COMMAND,))

    def allocator() -> ThrustAllocatorNode:  # thrust as it is asked for, lag and all
        return ThrustAllocatorNode(parameter_overrides=parameters(lag_compensation=0.0))

    with graph_of(allocator, peer) as (spinner, (node, other)):
        spin_until(spinner, lambda: node.count_publishers("wrench_command") == 1)
        spin_until(spinner, lambda: other.count_publishers("thruster_command") == 1)
        spin_until(spinner, lambda: node.missing_peers() == [nobody_reads(topics.WRENCH_ACHIEVED)])
        other.say(topics.WRENCH_COMMAND, Wrench(0, np.array([np.nan, 0, 0, 0, 0, 0])))
        errors: list = []

        def reported() -> bool:
            said = other.heard[topics.DIAGNOSTICS.name]
            errors[:] = [status for status in said if status.level == diagnostics.ERROR]
            return bool(errors)

        spin_until(spinner, reported)
        other.say(topics.WRENCH_COMMAND, Wrench(50_000_000, np.array([10.0, 0, 0, 0, 0, 0])))
        spin_until(spinner, lambda: bool(other.heard[topics.THRUSTER_COMMAND.name]))
        command = other.heard[topics.THRUSTER_COMMAND.name][-1]
    assert "wrench_command" in errors[0].message
    assert "nan" in errors[0].message
    assert errors[0].number("refused") == 1
    assert command.thrust[VEHICLE.thruster_names.index("main")] == pytest.approx(10.0, abs=0.01)


def test_a_path_that_cannot_be_followed_is_rejected_with_its_reason(tmp_path):
    scenario = tmp_path / "too_fast.yaml"
    scenario.write_text(TOO_FAST)
    outcome = uvms_here(tmp_path / "run", "run", str(scenario), "--composed")
    assert outcome.code == 2
    assert "error: the planner rejected the goal: path too fast: " in outcome.err
    assert "times slower it can be followed" in outcome.err
    simulated = uvms_here(tmp_path / "simulated", "simulate", str(scenario))
    assert simulated.code == 2
    assert "path too fast" in simulated.err


def test_a_wrong_parameter_is_named_with_what_is_allowed():
    def plant() -> PlantNode:
        return PlantNode(parameter_overrides=parameters(pace="fast"))

    with pytest.raises(ConfigError, match=r"pace: Input should be 'lockstep' or 'realtime'"):
        with graph_of(plant):
            pass
