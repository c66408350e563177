"""Which node fills which role of the graph: ours, the user's, or one that the user starts."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from uvms_bringup.errors import RunError
from uvms_core import registry, topics

_PART = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
"""What ROS takes for a part of a namespace."""


@dataclass(frozen=True)
class Cast:
    """The nodes of a run.

    Args:
        nodes: by role, the entry or `module:Class` of the node that takes the place of ours.
        absent: roles that the run leaves to the user.
        namespace: of all nodes; "" is the root.
    """

    nodes: Mapping[str, str] = field(default_factory=dict)
    absent: frozenset[str] = frozenset()
    namespace: str = ""

    @classmethod
    def parse(
        cls, nodes: Iterable[str] = (), without: Iterable[str] = (), namespace: str = ""
    ) -> "Cast":
        """From the options `--node ROLE=NODE`, `--without ROLE` and `--namespace NAME`.

        Raises:
            RunError: a role is unknown, given twice or cannot be left out; lists the choices.
            PluginError: a node is unknown.
        """
        chosen: dict[str, str] = {}
        for text in nodes:
            role, equals, node = text.partition("=")
            if not equals or not node:
                raise RunError(
                    f"--node {text!r}: write ROLE=NODE, NODE as my_package.my_node:MyNode"
                )
            _check_role("--node", role)
            if role in chosen:
                raise RunError(f"--node: {role} is given twice: {chosen[role]} and {node}")
            chosen[role] = registry.check(registry.NODES, node)
        absent = frozenset(_check_role("--without", role) for role in without)
        if topics.PLANT in absent:
            raise RunError(
                f"--without {topics.PLANT}: it owns time; replace it with --node instead"
            )
        if both := absent & chosen.keys():
            raise RunError(f"{', '.join(sorted(both))}: given to both --node and --without")
        return cls(chosen, absent, _namespace(namespace))

    def node_of(self, role: str) -> str:
        """Name or path of the node that fills a role."""
        return self.nodes.get(role, role)

    @property
    def started(self) -> tuple[str, ...]:
        """Roles whose nodes the run starts, in the order of the table."""
        return tuple(role for role in topics.NODES if role not in self.absent)


def _check_role(option: str, role: str) -> str:
    if role not in topics.NODES:
        raise RunError(f"{option} {role!r}: choose one of {', '.join(topics.NODES)}")
    return role


def _namespace(text: str) -> str:
    name = text.strip("/")
    if name and not all(_PART.fullmatch(part) for part in name.split("/")):
        raise RunError(
            f"--namespace {text!r}: use letters, digits and _, not beginning with a digit,"
            " with / between its parts"
        )
    return name
