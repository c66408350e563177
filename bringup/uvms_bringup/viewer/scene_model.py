"""What stands where at a time: the whole scene in plain arrays, for whatever draws it."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from uvms_bringup.viewer.elements import Node, Places
from uvms_bringup.viewer.moment import Moment, tool_pose
from uvms_bringup.viewer.pushes import Pushes
from uvms_bringup.viewer.sensor_views import SensorViews
from uvms_bringup.viewer.surroundings import Surroundings
from uvms_bringup.viewer.tool_paths import ToolPaths
from uvms_bringup.viewer.uncertainty import error_nodes, error_places
from uvms_bringup.viewer.vehicle_body import VehicleBody
from uvms_core.scene import Obstacle
from uvms_core.signals import Array
from uvms_core.vehicle.vehicle import Vehicle

ESTIMATED, TRUE = "estimated", "true"
"""Nodes of the vehicle as the filter sees it, which is solid, and as it is, which is a ghost."""
GHOST = 0.3
"""Opacity of the true vehicle."""
LONGEST = 0.4
"""Length of the longest arrow, as a part of the hull's length."""
LINE = 0.004
"""Width of the tool's lines, as a part of the hull's length."""


def _no_times() -> Array:
    return np.empty(0)


def _no_points() -> Array:
    return np.empty((0, 3))


@dataclass(frozen=True)
class Setting:
    """What of the scene stays: the vehicle, the world, and the run as a whole where it is known."""

    vehicle: Vehicle
    obstacles: tuple[Obstacle, ...] = ()
    asked: Array | None = None  # (j, 3) m, path of the goal
    times: Array = field(default_factory=_no_times)  # (k,) s
    travelled: Array = field(default_factory=_no_points)  # (k, 3) m, the tool at these times
    force_scale_n: float | None = None  # of the longest arrow; None: the greatest thrust
    middle: Array = field(default_factory=lambda: np.zeros(3))  # (3,) m, what the run is around


class SceneModel:
    """The nodes of a scene, and their places at any moment."""

    def __init__(self, setting: Setting) -> None:
        vehicle = setting.vehicle
        self.vehicle = vehicle
        self.estimated = VehicleBody(vehicle, ESTIMATED)
        self.true = VehicleBody(vehicle, TRUE, GHOST, details=False)
        self.size = 2.0 * float(self.estimated.size[1].max())
        """Greatest length of the hull, m."""
        self.diagonal = 2.0 * float(np.linalg.norm(self.estimated.size[1]))
        """Of the box around the hull, m."""
        self.line_m = LINE * self.size
        """Width of the tool's lines, m."""
        self._views = SensorViews(vehicle, ESTIMATED, self.size)
        greatest = max((item.greatest_n for item in vehicle.thrusters), default=1.0)
        scale = greatest if setting.force_scale_n is None else setting.force_scale_n
        self.pushes = Pushes(vehicle, ESTIMATED, LONGEST * self.size, scale)
        self._world = Surroundings(vehicle, setting.obstacles, self.size, setting.middle)
        self._paths = ToolPaths(setting.times, setting.travelled, setting.asked, self.line_m)
        self.nodes = _by_name(
            (
                *self._world.nodes,
                *self.true.nodes,
                *self.estimated.nodes,
                *self._views.nodes,
                *self.pushes.nodes,
                *self._paths.nodes,
                *error_nodes(),
            )
        )

    @property
    def still(self) -> set[str]:
        """Nodes of the vehicles that never move in their parents."""
        return self.estimated.still | self.true.still

    def places(self, moment: Moment) -> Places:
        """Where every moving node is; with `all_places` also those that stand still."""
        turned = None if moment.thrusts is None else moment.thrusts.turned
        shown = moment.estimated or moment.true
        found = self.estimated.places(shown, turned)
        found |= self._views.places(shown)
        found |= self.true.places(moment.true, turned)
        found |= self.pushes.places(moment.thrusts, moment.forces)
        found |= self._world.places(shown, moment.current)
        found |= self._paths.places(moment)
        covariance = None if moment.estimated is None else moment.covariance
        if shown is not None:
            tool = tool_pose(self.vehicle, shown)[0]
            found |= error_places(covariance, shown.position, tool)
        return found

    def shown_root(self, places: Places) -> str:
        """The node of the vehicle that is solid, which stands for the true one where no filter
        runs.
        """
        return self.estimated.root if places[self.estimated.root].visible else self.true.root

    def all_places(self, moment: Moment) -> Places:
        """Where every node is."""
        return {name: node.place for name, node in self.nodes.items()} | self.places(moment)


def _by_name(nodes: Iterable[Node]) -> dict[str, Node]:
    return {node.name: node for node in nodes}
