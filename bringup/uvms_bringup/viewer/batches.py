"""Parts that never move against one another, as one mesh: a page draws few things fast.

Without a graphics card the number of meshes is what a frame costs, not that of their triangles.
"""

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from uvms_bringup.viewer.elements import Look, Node, parent, world_pose
from uvms_bringup.viewer.meshes import unit_mesh
from uvms_core.signals import Array


@dataclass(frozen=True)
class Batch:
    """A mesh that stands for several nodes of one colour."""

    name: str
    look: Look
    vertices: Array  # (v, 3) m, in the node that it is below
    faces: np.ndarray  # (f, 3)


def batches(nodes: dict[str, Node], moving: Collection[str]) -> tuple[list[Batch], set[str]]:
    """The batches of a scene, and the nodes that they stand for, which need not be drawn.

    Args:
        nodes: of the scene by name, parents before their children.
        moving: those whose places change; all others stay where they are in their parents.
    """
    groups: dict[tuple[str, Look], list[str]] = {}
    for name, node in nodes.items():
        if name not in moving and _may_join(node):
            groups.setdefault((_carrier(name, moving), node.look), []).append(name)  # type: ignore[arg-type]
    found, gone = [], set()
    for number, ((carrier, look), names) in enumerate(groups.items()):
        if len(names) > 1:
            own = f"{carrier}/batch_{number}" if carrier else f"batch_{number}"
            found.append(Batch(own, look, *_merged([nodes[n] for n in names], carrier, nodes)))
            gone |= set(names)
    return found, gone


def _may_join(node: Node) -> bool:
    return node.look is not None and node.look.kind != "line" and not node.label


def _carrier(name: str, moving: Collection[str]) -> str:
    """The nearest node above that moves; "" is the world."""
    above = parent(name)
    while above and above not in moving:
        above = parent(above)
    return above


def _merged(members: list[Node], carrier: str, nodes: dict[str, Node]) -> tuple[Array, np.ndarray]:
    """Vertices in the carrier's frame, and faces."""
    places = {name: node.place for name, node in nodes.items() if name.startswith(f"{carrier}/")
              or not carrier}  # fmt: skip
    vertices, faces, count = [], [], 0
    for node in members:
        assert node.look is not None  # what `_may_join` says
        corners, triangles = unit_mesh(node.look.kind)
        centre, R = world_pose(node.name, places)
        vertices.append(centre + (corners * node.place.size) @ R.T)
        faces.append(triangles + count)
        count += len(corners)
    return np.concatenate(vertices), np.concatenate(faces)
