"""Where the sensors of a vehicle look: beams of the Doppler log, and what cameras see."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uvms_bringup.viewer.elements import Colour, Look, Node, Place, Places
from uvms_bringup.viewer.moment import Posture
from uvms_core.description.tree import basis
from uvms_core.rotations import matrix_to_quat
from uvms_core.signals import Array
from uvms_core.vehicle.frames import mounting_pose
from uvms_core.vehicle.vehicle import Vehicle

BEAM: Colour = (0.30, 0.75, 0.95)
VIEW: Colour = (0.20, 0.45, 0.75)
BEAM_ANGLE_DEG = 30.0
"""Of the four beams of a Doppler log from its axis, as in most of them: the vehicle file does not
say."""
BEAM_HALF_WIDTH_DEG = 2.0
REACH = 1.5
"""Length of a beam or view that nothing ends before, in lengths of the hull."""
EDGES = (0, 1, 2, 3, 4, 1, 0, 2, 0, 3, 0, 4)
"""All edges of a pyramid in one go: 0 is its tip."""


@dataclass(frozen=True)
class _Beam:
    """In the body's frame."""

    start: Array  # (3,) m
    along: Array  # (3,) unit vector


class SensorViews:
    """Beams and views below the node of a vehicle's body.

    Args:
        vehicle: its file.
        root: node of its body.
        size: length of its hull, m.
    """

    def __init__(self, vehicle: Vehicle, root: str, size: float) -> None:
        self._reach = REACH * size
        self._seabed = vehicle.environment.seabed_depth_m
        self._beams = {f"{root}/beam_{n}": beam for n, beam in enumerate(_beams(vehicle))}
        self.nodes = [
            Node(name, Look("cone", BEAM, 0.25), self._place(beam, self._reach))
            for name, beam in self._beams.items()
        ]
        width = np.full(3, 0.003 * size)
        self.nodes += [
            Node(f"{root}/view_{name}", Look("line", VIEW),
                 Place(size=width, points=_pyramid(section, self._reach)))
            for name, section in vehicle.sensors.mounted.items()
            if hasattr(section, "field_of_view_deg")
        ]  # fmt: skip

    def places(self, posture: Posture | None) -> Places:
        """Beams end at the seabed."""
        if posture is None or self._seabed is None:
            return {}
        position, R = posture.pose
        found = {}
        for name, beam in self._beams.items():
            down = float((R @ beam.along)[2])
            height = self._seabed - float((position + R @ beam.start)[2])
            ends = down > 0.0 and 0.0 < height < self._reach * down
            found[name] = self._place(beam, height / down if ends else self._reach)
        return found

    def _place(self, beam: _Beam, length: float) -> Place:
        radius = length * np.tan(np.radians(BEAM_HALF_WIDTH_DEG))
        middle = beam.start + 0.5 * length * beam.along
        quaternion = matrix_to_quat(basis(-beam.along, 2))
        return Place(middle, quaternion, np.array([radius, radius, 0.5 * length]))


def _beams(vehicle: Vehicle) -> list[_Beam]:
    """The four of the Doppler log, where there is one."""
    if (section := vehicle.sensors.dvl) is None:
        return []
    start, R = mounting_pose(section)
    tilt = np.radians(BEAM_ANGLE_DEG)
    azimuths = np.radians([45.0, 135.0, 225.0, 315.0])
    return [
        _Beam(start, R @ [np.sin(tilt) * np.cos(a), np.sin(tilt) * np.sin(a), np.cos(tilt)])
        for a in azimuths
    ]


def _pyramid(section: Any, reach: float) -> Array:
    """Edges of what a camera sees, in the body's frame; it looks along x of its mounting."""
    start, R = mounting_pose(section)
    length = min(reach, section.max_range_m)
    right, down = np.tan(0.5 * np.radians(section.field_of_view_deg))
    corners = [[1.0, -right, -down], [1.0, right, -down], [1.0, right, down], [1.0, -right, down]]
    places = np.vstack([np.zeros(3), length * np.array(corners)])
    return np.asarray(start + places[list(EDGES)] @ R.T)
