"""The pictures of the viewer in the documentation: which run, which moment, which camera."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from uvms_bringup.viewer.describe import describe
from uvms_bringup.viewer.elements import world_pose
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.scene_model import SceneModel

ROCKS = (
    "obstacles=[{name: rock, sphere: {center_m: [2.6, -0.5, 11.2], radius_m: 0.5}},"
    " {name: wall, box: {center_m: [2.9, 1.2, 11.0], size_m: [0.3, 1.2, 2.0]}}]"
)
SEABED = "vehicle_overrides={environment.seabed_depth_m: 12.0}"
PUSH = (
    "events=[{at_s: 6.0, until_s: 20.0, wrench: {force_n: [0.0, 25.0, -8.0],"
    " moment_nm: [0.0, 0.0, 0.0], frame: world}}]"
)
TETHER = "vehicle_overrides={tether: {reference_depth_m: 9.0, weight_per_m_n: -2.0}}"
DEAD = "events=[{at_s: 10.0, thruster: vertical_fore_port, effectiveness: 0.0}]"


@dataclass(frozen=True)
class Shot:
    """A picture: `docs/figures/view_NAME.png`, with its description as JSON beside it."""

    name: str
    scenario: str
    duration_s: float
    at_s: float
    camera: str
    settings: tuple[str, ...] = ()
    vehicle: str | None = None

    @property
    def arguments(self) -> list[str]:
        """Of `uvms simulate`."""
        sets = [word for each in self.settings for word in ("--set", each)]
        vehicle = [] if self.vehicle is None else ["--vehicle", self.vehicle]
        return [self.scenario, "--duration", f"{self.duration_s:g}", *vehicle, *sets]


GALLERY = (
    Shot("obstacles", "hover", 8.0, 8.0, "wide", (ROCKS, SEABED)),
    Shot("push", "hover", 12.0, 10.0, "chase", (PUSH, TETHER)),
    Shot("marker", "manipulation_marker", 8.0, 8.0, "wide"),
    Shot("path", "manipulation", 60.0, 60.0, "tool"),
    Shot("thruster", "arm_swing", 16.0, 14.0, "chase", (DEAD,)),
    Shot("bluerov2", "hover", 6.0, 6.0, "wide", (), "bluerov2_alpha5"),
)
MOVIE = Shot("swing", "arm_swing", 52.0, 0.0, "bow")
MOVIE_SPEED = 6.5
MOVIE_TOLD_S = 0.0, 13.0, 23.0, 36.0
"""Moments of the movie that its description has."""


def movie_told(source: LogSource) -> dict[str, Any]:
    """What the movie of a run shows at some moments, as `describe` tells of a picture, and the arm.

    Of the arm it is the places of its links and tool, in map_ned.
    """
    model, shown = SceneModel(source.setting), {}
    for time in MOVIE_TOLD_S:
        moment = source.moment(time)
        told = describe(model, moment, MOVIE.camera)["shown"]
        places = model.all_places(moment)
        for name in (*model.estimated.links, model.estimated.tool):
            told[name] = ["frame", "", np.round(world_pose(name, places)[0], 3).tolist()]
        shown |= {f"{time:g} s: {name}": what for name, what in told.items()}
    first = describe(model, source.moment(MOVIE_TOLD_S[0]), MOVIE.camera)
    return {"speed": MOVIE_SPEED, "camera": first["camera"], "shown": shown}
