"""The table of topics holds together."""

import pytest

from uvms_core import topics


def test_names_are_unique():
    names = [topic.name for topic in topics.ALL]
    assert len(set(names)) == len(names)
    assert topics.BY_NAME["odometry"] is topics.ODOMETRY


@pytest.mark.parametrize(
    ("topic", "namespace", "name"),
    [
        (topics.ODOMETRY, "", "/odometry"),
        (topics.ODOMETRY, "/", "/odometry"),
        (topics.ODOMETRY, "/fleet/auv1", "/fleet/auv1/odometry"),
        (topics.TRUE_ODOMETRY, "auv1", "/auv1/ground_truth/odometry"),
        (topics.CLOCK, "auv1", "/clock"),
    ],
)
def test_relative_names_fall_under_the_namespace(topic, namespace, name):
    assert topic.resolve(namespace) == name


def test_no_node_of_the_loop_reads_the_truth():
    """Of itself; `navigation.source: truth` adds it to what navigation reads, as a baseline."""
    for name, node in topics.NODES.items():
        assert not [t for t in node.inputs if t.name.startswith("ground_truth")], name


def test_every_input_is_some_nodes_output():
    given = {topic for node in topics.NODES.values() for topic in node.outputs}
    for name, node in topics.NODES.items():
        assert set(node.inputs) <= given, name


def test_every_output_has_one_source():
    outputs = [topic.name for node in topics.NODES.values() for topic in node.outputs]
    assert len(set(outputs)) == len(outputs)
