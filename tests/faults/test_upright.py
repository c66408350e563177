"""A plant that has capsized says so on /diagnostics: on a graph each second, in process at last."""

import numpy as np
import pytest
from in_process import Peer, graph_of, parameters, spin_until
from std_srvs.srv import Trigger

from uvms_analysis.log.read import RunLog
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core import diagnostics, topics
from uvms_core.attitude import attitude_status
from uvms_core.checks import ATTITUDE_DEG
from uvms_core.rotations import rpy_to_quat
from uvms_dynamics.nodes.plant import PlantNode

CAPSIZED = (148.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("degrees", "level"),
    [
        ((ATTITUDE_DEG - 0.1, 0.0, 170.0), diagnostics.OK),
        ((-ATTITUDE_DEG - 0.1, 0.0, 0.0), diagnostics.WARN),
        ((0.0, ATTITUDE_DEG + 0.1, 0.0), diagnostics.WARN),
        (CAPSIZED, diagnostics.WARN),
    ],
)
def test_the_level_goes_by_roll_and_pitch(degrees, level):
    assert attitude_status(rpy_to_quat(*np.deg2rad(degrees)))[0] == level


def test_a_capsized_plant_warns_each_second(saw):
    def plant():
        values = {"auto_start": False, "pace": "realtime", "initial_rpy_deg": list(CAPSIZED)}
        return PlantNode(parameter_overrides=parameters(**values))

    with graph_of(plant, lambda: Peer((topics.DIAGNOSTICS,))) as (spinner, (node, peer)):
        heard = peer.heard[topics.DIAGNOSTICS.name]

        def tilted():
            return [one for one in heard if "beyond 30 deg" in one.message]

        spin_until(spinner, lambda: node.count_subscribers("/diagnostics") >= 1)
        assert node._answer_start(None, Trigger.Response()).success
        # It rights itself within some seconds.
        spin_until(spinner, lambda: bool(heard) and heard[-1].stamp > 6_000_000_000)
    assert {(one.name, one.level) for one in tilted()} == {("plant", diagnostics.WARN)}
    assert tilted()[0].stamp == 0
    assert np.all(np.diff([one.stamp for one in tilted()]) >= 1_000_000_000)
    saw("a capsized plant on the graph", "WARN on /diagnostics once a second, names the angles")


def test_a_capsized_plant_is_named_at_the_end_of_a_run_in_process(tmp_path):
    settings = ["control.enabled=false", f"plant.initial_rpy_deg={list(CAPSIZED)}"]
    scenario = load_scenario("hover", settings, duration_s=0.5)
    prepare(scenario, str(tmp_path / "run"), "lockstep", "uvms").run_simulation()
    (status,) = RunLog.open(tmp_path / "run" / "run.mcap").statuses(topics.PLANT)
    assert status.level == diagnostics.WARN
    assert "beyond 30 deg" in status.message
