"""Hull, thrusters, lights, sensors and arm of a vehicle as nodes, and where a posture puts them."""

from collections.abc import Iterator

import numpy as np

from uvms_analysis.hull_chord import tunnel
from uvms_bringup.viewer.elements import Colour, Kind, Look, Node, Place, Places
from uvms_bringup.viewer.moment import Posture
from uvms_core.description.solids import THRUSTER_RADIUS_M, Solid, hull_solids, link_solids
from uvms_core.description.tree import basis
from uvms_core.rotations import matrix_to_quat
from uvms_core.signals import Array
from uvms_core.vehicle.frames import Pose, arm_frames, compose, mounting_pose
from uvms_core.vehicle.outline import BoxOutline, box_outline, hull_outlines
from uvms_core.vehicle.vehicle import Vehicle

HULL: Colour = (0.96, 0.74, 0.16)
LINKS: tuple[Colour, Colour] = ((0.90, 0.42, 0.16), (0.66, 0.69, 0.73))
DARK: Colour = (0.22, 0.24, 0.28)
BLADE: Colour = (0.85, 0.87, 0.90)
FIN: Colour = (0.80, 0.60, 0.12)
PORT: Colour = (0.90, 0.05, 0.05)
STARBOARD: Colour = (0.05, 0.75, 0.15)
TOOL: Colour = (0.10, 0.10, 0.12)
BLADE_M = (0.9 * THRUSTER_RADIUS_M, 0.15 * THRUSTER_RADIUS_M, 0.06 * THRUSTER_RADIUS_M)
"""Half sides of a propeller's two blades, which lie across its axis."""
LIGHT = 0.03
"""Radius of the side lights, as a part of the hull's length."""


class VehicleBody:
    """A vehicle below one node.

    Args:
        vehicle: its file.
        root: name of the node.
        opacity: of all its parts; a ghost has less than 1.
        details: side lights and propellers, too, which a ghost does without.
    """

    def __init__(
        self, vehicle: Vehicle, root: str, opacity: float = 1.0, details: bool = True
    ) -> None:
        self.root = root
        self._vehicle, self._opacity = vehicle, opacity
        self.size = hull_size(vehicle)
        self.links = [f"{root}/link_{number}" for number in range(len(vehicle.arm.links))]
        self.tool = f"{root}/tool"
        turning = vehicle.thrusters if details else ()
        self.propellers = [f"{root}/thruster_{item.name}/propeller" for item in turning]
        self.nodes = [Node(root), *self._hull(), *self._thrusters(), *self._arm()]
        if details:
            self.nodes += self._lights()
        moving = {root, *self.links, self.tool, *self.propellers}
        self.still = {node.name for node in self.nodes} - moving

    def places(self, posture: Posture | None, turned: Array | None = None) -> Places:
        """Where the moving nodes are; hidden where there is no posture.

        Args:
            posture: of body and joints.
            turned: (m,) rad, by how much each propeller has turned.
        """
        if posture is None:
            return {self.root: Place(visible=False)}
        frames = arm_frames(self._vehicle.arm, posture.q)
        tool = compose(frames[-1], mounting_pose(self._vehicle.arm.tool))
        found = {self.root: Place(posture.position, posture.quaternion)}
        found |= {name: place_of(pose) for name, pose in zip(self.links, frames[1:], strict=True)}
        found[self.tool] = place_of(tool)
        if turned is not None and self.propellers:
            for name, angle in zip(self.propellers, 0.5 * turned, strict=True):
                found[name] = Place(quaternion=np.array([0.0, 0.0, np.sin(angle), np.cos(angle)]))
        return found

    def _node(self, name: str, kind: Kind, pose: Pose, size: Array, colour: Colour) -> Node:
        look = Look(kind, colour, self._opacity)
        place = place_of(pose)
        return Node(f"{self.root}/{name}", look, Place(place.position, place.quaternion, size))

    def _hull(self) -> Iterator[Node]:
        hull = self._vehicle.hull
        if hull.spheroid is not None:
            half = 0.5 * np.array([hull.spheroid.length_m, *[hull.spheroid.diameter_m] * 2])
            yield self._node("hull", "sphere", (np.zeros(3), np.eye(3)), half, HULL)
        elif hull.boxes:
            for number, box in enumerate(map(box_outline, hull.boxes)):
                pose = box.centre, box.rotation
                yield self._node(f"hull_{number}", "box", pose, box.half, HULL)
        else:
            yield self._solid("hull", hull_solids(hull)[0], HULL)
        for fin in hull.fins:
            across = np.cross(fin.normal, fin.chord)
            axes = np.column_stack([fin.chord, across, fin.normal])
            side = 0.5 * np.sqrt(fin.area_m2)
            half = np.array([side, side, 0.05 * side])
            yield self._node(f"fin_{fin.name}", "box", (np.array(fin.position_m), axes), half, FIN)

    def _solid(self, name: str, solid: Solid, colour: Colour) -> Node:
        if solid.length == 0.0:
            return self._node(name, "sphere", solid.pose, np.full(3, solid.radius), colour)
        size = np.array([solid.radius, solid.radius, 0.5 * solid.length])
        return self._node(name, "cylinder", solid.pose, size, colour)

    def _thrusters(self) -> Iterator[Node]:
        """Each with z along its positive thrust: a duct, and a propeller at its after end."""
        for item in self._vehicle.thrusters:
            place, along = np.array(item.position_m), np.array(item.direction)
            first, last = tunnel(self._vehicle, place, along)
            name = f"thruster_{item.name}"
            yield Node(f"{self.root}/{name}", place=place_of((place, basis(along, 2))))
            middle = np.array([0.0, 0.0, 0.5 * (first + last)])
            size = np.array([THRUSTER_RADIUS_M, THRUSTER_RADIUS_M, 0.5 * (last - first)])
            yield self._node(f"{name}/duct", "cylinder", (middle, np.eye(3)), size, DARK)
            if (propeller := f"{self.root}/{name}/propeller") not in self.propellers:
                continue
            yield Node(propeller)
            for number, (x, y) in enumerate(((0, 1), (1, 0))):
                half = np.array([BLADE_M[x], BLADE_M[y], BLADE_M[2]])
                behind = np.array([0.0, 0.0, first - 2.0 * BLADE_M[2]])
                blade = f"{name}/propeller/blade_{number}"
                yield self._node(blade, "box", (behind, np.eye(3)), half, BLADE)

    def _arm(self) -> Iterator[Node]:
        for number, link in enumerate(self._vehicle.arm.links):
            yield Node(self.links[number])
            for part, solid in enumerate(link_solids(link)):
                yield self._solid(f"link_{number}/{part}", solid, LINKS[number % 2])
        yield Node(self.tool)
        size = 0.5 * link_solids(self._vehicle.arm.links[-1])[0].radius
        yield self._node("tool/tip", "sphere", (np.zeros(3), np.eye(3)), np.full(3, size), TOOL)

    def _lights(self) -> Iterator[Node]:
        """Red to port and green to starboard, as ships have them."""
        centre, half = self.size
        size = np.full(3, LIGHT * 2.0 * half[0])
        for name, colour, side in (("port", PORT, -1.0), ("starboard", STARBOARD, 1.0)):
            place = centre + side * np.array([0.0, half[1], 0.0])
            yield self._node(f"light_{name}", "sphere", (place, np.eye(3)), size, colour)


def hull_size(vehicle: Vehicle) -> tuple[Array, Array]:
    """Centre (3,) and half extents (3,) of the hull along the body's axes, m."""
    hull = vehicle.hull
    if hull.spheroid is not None:
        across = 0.5 * hull.spheroid.diameter_m
        return np.zeros(3), np.array([0.5 * hull.spheroid.length_m, across, across])
    boxes = [part for part in hull_outlines(hull) if isinstance(part, BoxOutline)]
    reach = [np.abs(box.rotation) @ box.half for box in boxes]
    low = np.min([box.centre - half for box, half in zip(boxes, reach, strict=True)], axis=0)
    high = np.max([box.centre + half for box, half in zip(boxes, reach, strict=True)], axis=0)
    return 0.5 * (low + high), 0.5 * (high - low)


def place_of(pose: Pose) -> Place:
    """The place of a pose."""
    return Place(pose[0], matrix_to_quat(pose[1]))
