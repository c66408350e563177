"""Events on the real graph: the same as in the process, and by service while the run is on."""

from collections.abc import Iterator
from functools import partial

import numpy as np
import pytest
from graph import Outcome, finished, uvms_here
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.node import Node
from std_srvs.srv import Trigger

from uvms_analysis.log.compare import compare
from uvms_analysis.log.read import RunLog
from uvms_bringup.cast import Cast
from uvms_bringup.errors import ScenarioError
from uvms_bringup.ros.run import check_own_plant
from uvms_bringup.scenario import load_scenario
from uvms_core import registry, topics
from uvms_core.ros.convert import message_class
from uvms_core.ros.subscribe import qos_profile
from uvms_core.signals import to_seconds
from uvms_msgs.srv import ApplyEvent

SCENARIO = """
description: something of everything
duration_s: 3.0
seed: 5
vehicle: reference_auv
plant:
  vehicle_overrides: {hull.cb_m: [0.0, 0.0024, 0.0]}
  mismatch: {mass: 0.1, added_mass: 0.2, damping: 0.2, link_mass: 0.1, thrust: 0.05}
events:
  - {at_s: 0.5, payload: {mass_kg: 1.02, volume_m3: 0.0005, at_m: [0.0, 0.0, 0.1]}}
  - {at_s: 2.0, payload: release}
  - {at_s: 0.6, thruster: side_fore, effectiveness: 0.5}
  - {at_s: 0.7, until_s: 1.5, sensor: dvl, fault: silent}
  - {at_s: 1.0, until_s: 1.4, sensor: imu, fault: silent}
  - {at_s: 1.6, until_s: 2.0, sensor: imu, fault: latency, latency_s: 0.08}
  - {at_s: 1.0, until_s: 2.5, sensor: pressure, fault: noise, std: 100.0}
  - {at_s: 1.0, until_s: 1.5, sensor: imu, fault: bias, field: angular_velocity, bias: 0.01}
  - {at_s: 1.2, until_s: 1.7, wrench: {force_n: [5.0, 0.0, 0.0]}}
  - {at_s: 1.5, joint: elbow, stuck: true}
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory) -> tuple[Outcome, Outcome]:
    folder = tmp_path_factory.mktemp("events")
    (folder / "everything.yaml").write_text(SCENARIO)
    name = str(folder / "everything.yaml")
    graph = finished(uvms_here(folder / "graph", "run", name, "--composed"))
    return graph, finished(uvms_here(folder / "alone", "simulate", name))


def test_the_graph_in_lockstep_equals_the_simulation(runs):
    graph, alone = (outcome.log for outcome in runs)
    apart = (topics.DIAGNOSTICS, topics.TF)
    compared = [topic for topic in topics.ALL if topic.signal is not None and topic not in apart]
    for difference in compare(graph, alone, [*compared, topics.SENSOR_GAPS]):
        assert difference.recorded == difference.replayed == difference.common > 0, difference
        assert difference.greatest == 0.0, difference


def test_a_silent_sensor_does_not_stop_the_graph_nor_spoil_its_log(runs):
    for outcome in runs:
        summary = outcome.summary
        assert summary["lockstep_timeouts"] == 0
        assert summary["check"]["faults"] == []
        assert summary["sim_duration_s"] == pytest.approx(3.0)


def test_the_summary_tells_what_was_drawn_and_what_happened(runs):
    graph, alone = (outcome.summary for outcome in runs)
    assert graph["plant"] == alone["plant"]
    assert graph["plant"]["vehicle_overrides"] == {"hull.cb_m": [0.0, 0.0024, 0.0]}
    assert abs(graph["plant"]["mismatch"]["mass"]) <= 0.1
    assert graph["events"] == alone["events"]
    assert len(graph["events"]) == 10 + 6  # six of them end
    assert graph["events"][0] == {"at_s": 0.5, "text": "payload grasped: 1.02 kg, 0.5 l"}
    assert "plant_vehicle.yaml" in runs[0].log.attachments


def test_navigation_replays_a_log_with_silent_and_late_sensors(runs, tmp_path):
    replayed = finished(
        uvms_here(tmp_path, "replay", str(runs[0].folder / "run.mcap"), "--into", "navigation")
    )
    log = RunLog.open(replayed.folder / "replay.mcap")
    (difference,) = compare(runs[0].log, log, [topics.ODOMETRY])
    assert difference.recorded == difference.replayed == difference.common == 61
    assert difference.greatest == 0.0


class Caller:
    """Six nodes in lockstep in this process, and a peer that calls the plant."""

    def __init__(self, spinner, peer: Peer, plant: Node) -> None:
        self.spinner, self.peer, self.plant = spinner, peer, plant
        self._events = peer.create_client(ApplyEvent, "apply_event")
        clock = topics.CLOCK  # in lockstep the executor is never idle
        peer.create_subscription(
            message_class(clock), clock.name, lambda _: spinner.yield_turn(), qos_profile(clock.qos)
        )
        self._reset = peer.create_client(Trigger, "reset")

    @property
    def now(self) -> float:
        clock = self.peer.heard[topics.CLOCK.name]
        return to_seconds(clock[-1]) if clock else -1.0

    def run_to(self, time: float) -> None:
        spin_until(self.spinner, lambda: self.now >= time, rounds=400)

    def run_to_again(self, time: float) -> None:
        """After a reset: to this time of the new start."""
        clock = self.peer.heard[topics.CLOCK.name]

        spin_until(
            self.spinner,
            lambda: 0 in clock and to_seconds(max(clock[clock.index(0) :])) >= time,
            rounds=400,
        )

    def apply(self, text: str) -> ApplyEvent.Response:
        return self._call(self._events, ApplyEvent.Request(event=text))

    def reset(self) -> Trigger.Response:
        return self._call(self._reset, Trigger.Request())

    def _call(self, client, request):
        spin_until(self.spinner, client.service_is_ready)
        future = client.call_async(request)
        spin_until(self.spinner, future.done)
        return future.result()

    def thrust(self, since: float) -> np.ndarray:
        heard = self.peer.heard[topics.APPLIED_THRUST.name]
        return np.array([each.thrust for each in heard if to_seconds(each.stamp) >= since])


def _node(role: str) -> Node:
    make = registry.load(registry.NODES, role)
    return make(parameter_overrides=parameters(pace="lockstep"))


@pytest.fixture
def graph() -> Iterator[Caller]:
    makers = [partial(_node, role) for role in topics.NODES]
    heard = topics.CLOCK, topics.APPLIED_THRUST, topics.TRUE_ODOMETRY, topics.ODOMETRY
    with graph_of(*makers, lambda: Peer(heard)) as (spinner, nodes):
        roles = dict(zip(topics.NODES, nodes, strict=False))
        yield Caller(spinner, nodes[-1], roles[topics.PLANT])


def test_events_and_reset_by_service(graph):
    graph.run_to(1.0)
    answer = graph.apply("{thruster: side_fore, stuck_at_n: 12.0}")
    assert answer.success, answer.message
    assert answer.message.endswith("s: thruster side_fore: stuck at 12 N")
    refused = graph.apply("{thruster: main, effectiveness: 2.0}")
    assert not refused.success
    assert "effectiveness: Input should be less than or equal to 1" in refused.message
    later = graph.now + 1.0
    graph.run_to(later + 0.5)
    assert graph.thrust(later)[0, 1] == pytest.approx(12.0, rel=1e-3)
    heard = graph.peer.heard
    start = heard[topics.TRUE_ODOMETRY.name][0]
    for topic in (topics.CLOCK, topics.TRUE_ODOMETRY, topics.ODOMETRY, topics.APPLIED_THRUST):
        heard[topic.name].clear()
    answer = graph.reset()
    assert answer.success, answer.message
    spin_until(graph.spinner, lambda: 0 in heard[topics.CLOCK.name])
    graph.run_to_again(2.0)  # every node follows
    again = next(each for each in heard[topics.TRUE_ODOMETRY.name] if each.stamp == 0)
    np.testing.assert_array_equal(again.position, start.position)
    estimate = next(each for each in heard[topics.ODOMETRY.name] if each.stamp == 1_500_000_000)
    assert np.linalg.norm(estimate.position - start.position) < 0.3
    applied = next(
        each for each in heard[topics.APPLIED_THRUST.name] if each.stamp == 1_500_000_000
    )
    assert abs(applied.thrust[1] - 12.0) > 1.0  # the thruster is whole again
    assert not applied.thruster_safe


@pytest.mark.parametrize(
    ("setting", "name"),
    [
        ("events=[{at_s: 1.0, thruster: main, effectiveness: 0.0}]", "events"),
        ("plant.mismatch.mass=0.1", "plant.mismatch"),
        ("plant.vehicle_overrides={hull.cb_m: [0.0, 0.001, 0.0]}", "plant.vehicle_overrides"),
    ],
)
def test_a_plant_of_somebody_else_s_does_not_ignore_what_the_log_would_claim(setting, name):
    scenario = load_scenario("hover", [setting])
    with pytest.raises(ScenarioError, match=rf"^{name}: --node plant=rclpy.node:Node takes no"):
        check_own_plant(Cast.parse(["plant=rclpy.node:Node"]), scenario)
    check_own_plant(Cast.parse(["plant=uvms_dynamics.nodes.plant:PlantNode"]), scenario)
    check_own_plant(Cast(), scenario)
