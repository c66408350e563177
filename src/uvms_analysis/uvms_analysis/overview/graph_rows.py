"""What the nodes of the system exchange, as a table."""

from uvms_analysis.overview.columns import in_columns
from uvms_core import topics
from uvms_core.topics import NodeTopics, Topic
from uvms_core.vehicle import Vehicle

HEAD = ("topic", "type", "frame", "from", "to")


def graph_text(vehicle: Vehicle) -> str:
    """Every topic with the nodes that write and read it, then the actions."""
    graph = topics.nodes(vehicle)
    rows = [_row(topic, graph) for topic in topics.of(vehicle)]
    rows += [
        (action.name, action.type, "", "any client", node)
        for node, own in graph.items()
        for action in own.actions
    ]
    return in_columns([HEAD, *rows])


def _row(topic: Topic, graph: dict[str, NodeTopics]) -> tuple[str, ...]:
    writers = ", ".join(name for name, own in graph.items() if topic in own.outputs)
    readers = ", ".join(sorted(topics.readers(topic, graph)))
    return topic.name, topic.type, topic.frame, writers, readers
