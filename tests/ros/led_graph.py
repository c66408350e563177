"""The whole graph in the test process, with a conductor that leads it."""

from collections.abc import Iterator
from contextlib import contextmanager

from in_process import graph_of

from uvms_bringup.pace import Pace
from uvms_bringup.ros.conductor import Conductor
from uvms_bringup.ros.parameter_file import node_parameters
from uvms_bringup.ros.run_nodes import make_node
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import vehicle_file


@contextmanager
def running(folder, duration_s: float, goal, *others) -> Iterator[tuple]:
    """The composed graph, led up to the point where time goes: spinner, conductor, and `others`.

    others: makers of further nodes in the same executor.
    """
    scenario = load_scenario("manipulation", duration_s=duration_s)
    vehicle = scenario.load_vehicle()
    file = vehicle_file(folder, vehicle)
    parameters = node_parameters(scenario, file, Pace.parse("lockstep"))
    makers = [lambda node=node, own=own: make_node(node, own) for node, own in parameters.items()]

    def lead() -> Conductor:
        return Conductor(lambda *message: None, lambda: None, vehicle.joint_names)

    with graph_of(lead, *others, *makers) as (spinner, (conductor, *nodes)):
        conductor.conduct(spinner, goal)
        yield spinner, conductor, *nodes[: len(others)]
