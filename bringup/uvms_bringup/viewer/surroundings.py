"""What stands around the vehicle: seabed, surface, obstacles, tether, the way of the water."""

from collections.abc import Iterable, Iterator

import numpy as np

from uvms_bringup.viewer.elements import HIDDEN, Colour, Look, Node, Place, Places
from uvms_bringup.viewer.moment import Posture
from uvms_core.description.tree import basis
from uvms_core.rotations import matrix_to_quat, rpy_to_quat
from uvms_core.scene import SEABED, Obstacle
from uvms_core.signals import Array
from uvms_core.vehicle.outline import box_outline
from uvms_core.vehicle.vehicle import Vehicle

SAND: Colour = (0.76, 0.70, 0.55)
STONE: Colour = (0.55, 0.50, 0.44)
WATER: Colour = (0.35, 0.65, 0.90)
ROPE: Colour = (0.95, 0.85, 0.25)
CURRENT: Colour = (0.10, 0.45, 0.85)
MARKER: Colour = (0.95, 0.95, 0.95)
MARKER_HALF_M = np.array([0.075, 0.075, 0.003])
"""Half sides of the plate that stands for a marker: the vehicle file has no size of it."""
BEACON_RADIUS_M = 0.08
SEABED_HALF_M = 25.0
THICK_M = 0.05
TETHER, FLOW = "tether", "current"
FLOW_SCALE_M_S = 0.5
"""Speed of water whose arrow is as long as the vehicle."""
STILL_M_S = 1e-3
"""Water slower than this has no arrow."""


class Surroundings:
    """Nodes of the world.

    Args:
        vehicle: its file, which has the seabed's depth and the tether.
        obstacles: of the scenario.
        size: the vehicle's length, m.
        middle: (3,) m, around which the seabed is drawn.
    """

    def __init__(
        self, vehicle: Vehicle, obstacles: Iterable[Obstacle], size: float, middle: Array
    ) -> None:
        self._size = size
        self._has_tether = vehicle.tether is not None
        self.nodes = [*_seabed(vehicle, middle), *map(_obstacle, obstacles), *_marks(vehicle)]
        self.nodes.append(Node(FLOW, Look("arrow", CURRENT), HIDDEN))
        if self._has_tether:
            self.nodes.append(Node(TETHER, Look("line", ROPE), HIDDEN))

    def places(self, posture: Posture | None, current: Array | None) -> Places:
        """Where tether and current are."""
        found: Places = {}
        if posture is not None and self._has_tether:
            found[TETHER] = self._tether(posture)
        if posture is not None and current is not None:
            found[FLOW] = self._flow(posture, current)
        return found

    def _tether(self, posture: Posture) -> Place:
        """Straight up to the surface: the vehicle file does not say where it goes."""
        top = np.array([posture.position[0], posture.position[1], 0.0])
        points = np.array([posture.position, top])
        return Place(points=points, size=np.full(3, 0.008 * self._size))

    def _flow(self, posture: Posture, current: Array) -> Place:
        speed = float(np.linalg.norm(current))
        if speed < STILL_M_S:
            return HIDDEN
        length = self._size * speed / FLOW_SCALE_M_S
        start = posture.position - np.array([0.0, 0.0, 0.8 * self._size])
        width = 0.03 * self._size
        quaternion = matrix_to_quat(basis(current / speed, 2))
        return Place(start, quaternion, np.array([width, width, length]))


def _seabed(vehicle: Vehicle, middle: Array) -> Iterator[Node]:
    depth = vehicle.environment.seabed_depth_m
    if depth is not None:
        centre = np.array([middle[0], middle[1], depth + THICK_M])
        half = np.array([SEABED_HALF_M, SEABED_HALF_M, THICK_M])
        yield Node(SEABED, Look("box", SAND), Place(centre, size=half))


def _obstacle(obstacle: Obstacle) -> Node:
    name, look = f"obstacle_{obstacle.name.replace('/', '_')}", Look("sphere", STONE)
    if obstacle.sphere is not None:
        centre, size = np.array(obstacle.sphere.center_m), np.full(3, obstacle.sphere.radius_m)
        return Node(name, look, Place(centre, size=size), obstacle.name)
    assert obstacle.box is not None  # what the model checks
    box = box_outline(obstacle.box)
    place = Place(box.centre, matrix_to_quat(box.rotation), box.half)
    return Node(name, Look("box", STONE), place, obstacle.name)


def _marks(vehicle: Vehicle) -> Iterator[Node]:
    """What the vehicle's sensors look for: markers of cameras, transponders of acoustic fixes."""
    for name, section in vehicle.sensors.mounted.items():
        if (centre := getattr(section, "target_position_m", None)) is not None:
            turn = rpy_to_quat(*np.radians(getattr(section, "target_rpy_deg", np.zeros(3))))
            place = Place(np.array(centre), turn, MARKER_HALF_M)
            yield Node(f"marker_{name}", Look("box", MARKER), place, name)
        elif (source := getattr(section, "source_m", None)) is not None:
            size = np.full(3, BEACON_RADIUS_M)
            place = Place(np.array(source), size=size)
            yield Node(f"marker_{name}", Look("sphere", MARKER), place, name)
