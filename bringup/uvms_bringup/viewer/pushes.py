"""Arrows of what pushes the vehicle: thrusts, and the parts of the disturbance."""

import numpy as np

from uvms_bringup.viewer.elements import HIDDEN, Colour, Look, Node, Place, Places
from uvms_bringup.viewer.moment import Forces, Thrusts
from uvms_core.description.tree import basis
from uvms_core.rotations import matrix_to_quat
from uvms_core.signals import Array
from uvms_core.vehicle.vehicle import Vehicle

IDLE: Colour = (0.05, 0.55, 0.40)
FULL: Colour = (0.90, 0.10, 0.10)
"""Colours of a thrust arrow: none of its limit, and all of it or saturated."""
PARTS: dict[str, Colour] = {
    "restoring": (0.45, 0.35, 0.85),
    "coupling": (0.95, 0.55, 0.10),
    "external": (0.80, 0.10, 0.45),
}
"""Parts of the disturbance and their colours."""
WIDTH = 0.06
"""Radius of an arrow's head, as a part of the longest arrow."""
SHORTEST = 0.01
"""Arrows below this part of the longest are hidden."""


class Pushes:
    """Arrows below the node of a vehicle's body, all on one scale.

    Args:
        vehicle: its file.
        root: node of its body.
        longest: length of the arrow of `scale_n`, m.
        scale_n: force that has the longest arrow, N.
    """

    def __init__(self, vehicle: Vehicle, root: str, longest: float, scale_n: float) -> None:
        self._vehicle, self._root = vehicle, root
        self.longest, self.scale_n = longest, scale_n
        names = [f"{root}/thrust_{item.name}" for item in vehicle.thrusters]
        self._thrusts = names
        self._parts = {part: f"{root}/force_{part}" for part in PARTS}
        self.nodes = [Node(name, Look("arrow", IDLE), HIDDEN) for name in names]
        self.nodes += [
            Node(self._parts[part], Look("arrow", colour), HIDDEN) for part, colour in PARTS.items()
        ]

    def places(self, thrusts: Thrusts | None, forces: Forces | None) -> Places:
        """Where the arrows are."""
        found: Places = {}
        if thrusts is not None:
            for name, item, thrust, saturated in zip(
                self._thrusts, self._vehicle.thrusters, thrusts.thrust, thrusts.saturated,
                strict=True,
            ):  # fmt: skip
                share = 1.0 if saturated else min(abs(thrust) / item.greatest_n, 1.0)
                force = thrust * np.array(item.direction)
                found[name] = self._arrow(np.array(item.position_m), force, _between(share))
        if forces is not None:
            centre = np.array(self._vehicle.hull.cb_m)
            for part, name in self._parts.items():
                found[name] = self._arrow(centre, getattr(forces, part), PARTS[part])
        return found

    def _arrow(self, start: Array, force: Array, colour: Colour) -> Place:
        size = float(np.linalg.norm(force))
        if not size > SHORTEST * self.scale_n:
            return HIDDEN
        width = WIDTH * self.longest
        quaternion = matrix_to_quat(basis(force / size, 2))
        length = self.longest * size / self.scale_n
        return Place(start, quaternion, np.array([width, width, length]), colour=colour)


def _between(share: float) -> Colour:
    """From the idle to the full colour."""
    red, green, blue = (a + share * (b - a) for a, b in zip(IDLE, FULL, strict=True))
    return red, green, blue
