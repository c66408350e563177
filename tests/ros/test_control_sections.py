"""Gains on the graph: by rule where they are not set, and never those of another law."""

import pytest
from in_process import graph_of, parameters

from uvms_control import ControlConfig
from uvms_control.nodes.controller import ControllerNode
from uvms_core.errors import UvmsError
from uvms_core.ros.parameters import flatten


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"vehicle.k_rate": [3.0] * 6}, "'default' ignores vehicle.k_rate"),
        ({"law": "paper", "gains.noise_share": 0.1}, "'paper' ignores gains.noise_share"),
        ({"gains.bandwidth_rad_s": [1.0] * 3}, "bandwidth_rad_s"),
        (
            {"gains.bandwidth_rad_s": [1.0, 40.0, 1.0, 1.0, 1.0, 1.0]},
            "bandwidth_rad_s of sway: 40 rad/s makes the loop unstable",
        ),
    ],
)
def test_a_node_refuses_gains_that_its_law_ignores_or_does_not_bear(given, message):
    def make() -> ControllerNode:
        return ControllerNode(parameter_overrides=parameters(**given))

    with pytest.raises(UvmsError, match=message), graph_of(make):
        pass


def test_gains_that_are_not_set_are_those_by_rule_and_others_are_taken():
    assert "gains.bandwidth_rad_s" not in flatten(ControlConfig())
    own = {"gains.bandwidth_rad_s": [1.0] * 6}
    for given, expected in ({}, None), (own, (1.0,) * 6):

        def make(given=given) -> ControllerNode:
            return ControllerNode(parameter_overrides=parameters(**given))

        with graph_of(make) as (_, (node,)):
            assert node.config(ControlConfig).gains.bandwidth_rad_s == expected
