"""A plant that is started by hand beside another one."""

from in_process import Peer, graph_of, parameters, spin_until
from std_srvs.srv import Trigger

from uvms_core import diagnostics, topics
from uvms_dynamics.nodes.plant import PlantNode


def plant() -> PlantNode:
    return PlantNode(parameter_overrides=parameters(auto_start=False, pace="realtime"))


def test_a_plant_does_not_start_beside_another(saw):
    with graph_of(plant, lambda: Peer((), (topics.CLOCK,))) as (spinner, (node, _)):
        spin_until(spinner, lambda: node.count_publishers("/clock") == 2)
        answer = node._answer_start(None, Trigger.Response())
    assert not answer.success
    assert answer.message.startswith("another plant is here: /peer")
    assert "publishes '/clock'" in answer.message
    saw("a plant is started beside another", "it does not start, and names the other")


def test_a_running_plant_reports_another_that_turns_up(saw):
    def watcher() -> Peer:
        return Peer((topics.DIAGNOSTICS,))

    with graph_of(plant, watcher) as (spinner, (node, other)):
        spin_until(spinner, lambda: node.count_subscribers("/diagnostics") >= 1)
        assert node._answer_start(None, Trigger.Response()).success
        late = Peer((), (topics.JOINT_STATES,))
        spinner.add([late])
        errors: list = []

        def reported() -> bool:
            said = other.heard[topics.DIAGNOSTICS.name]
            errors[:] = [one for one in said if one.level == diagnostics.ERROR]
            return bool(errors)

        spin_until(spinner, reported)
    assert "another plant is here" in errors[0].message
    assert "'joint_states'" in errors[0].message
    saw("a second plant turns up", "the first reports ERROR on /diagnostics and names it")
