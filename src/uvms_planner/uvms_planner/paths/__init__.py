"""The words with which a scenario describes the end effector's path, one file each."""

from uvms_planner.paths.circle import Circle, Helix
from uvms_planner.paths.csv_table import CsvPath
from uvms_planner.paths.line import Line
from uvms_planner.paths.phases import PathPhase, PhasePath
from uvms_planner.paths.shape import PathPoints, PathShape
from uvms_planner.paths.waypoints import Waypoints

__all__ = [
    "Circle",
    "CsvPath",
    "Helix",
    "Line",
    "PathPhase",
    "PathPoints",
    "PathShape",
    "PhasePath",
    "Waypoints",
]
