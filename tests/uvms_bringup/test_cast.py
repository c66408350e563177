"""Which node fills which role: what the command line may ask for, and what it is refused."""

import pytest

from uvms_bringup.cast import Cast
from uvms_bringup.errors import RunError
from uvms_core import topics
from uvms_core.errors import PluginError


def test_by_default_every_role_is_filled_by_our_node():
    cast = Cast.parse()
    assert cast.started == tuple(topics.NODES)
    assert [cast.node_of(role) for role in cast.started] == list(topics.NODES)


def test_a_node_takes_the_place_of_ours_and_another_is_left_out():
    cast = Cast.parse(["controller=my_package.my_node:Mine"], ["navigation"], "/fleet/rov_1/")
    assert cast.node_of("controller") == "my_package.my_node:Mine"
    assert "navigation" not in cast.started
    assert cast.namespace == "fleet/rov_1"


@pytest.mark.parametrize(
    ("nodes", "without", "reason"),
    [
        (["controller"], [], "write ROLE=NODE"),
        (["pilot=a.b:C"], [], "--node 'pilot': choose one of plant, navigation"),
        (["controller=a.b:C", "controller=a.b:D"], [], "given twice: a.b:C and a.b:D"),
        ([], ["pilot"], "--without 'pilot': choose one of plant, navigation"),
        ([], ["plant"], "it owns time"),
        (["controller=a.b:C"], ["controller"], "controller: given to both --node and --without"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_choices(nodes, without, reason):
    with pytest.raises(RunError, match=reason):
        Cast.parse(nodes, without)


def test_an_unknown_node_is_refused_with_the_choices():
    with pytest.raises(PluginError, match=r"node 'mine' is unknown; choose one of controller, "):
        Cast.parse(["controller=mine"])


@pytest.mark.parametrize("name", ["1st", "a b", "a//b", "a/-b", "aüv"])
def test_a_namespace_that_ros_refuses_is_refused_here(name):
    with pytest.raises(RunError, match="--namespace"):
        Cast.parse(namespace=name)
