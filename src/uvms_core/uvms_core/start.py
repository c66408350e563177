"""Where a run starts, as the parts that need it agree on it."""

from typing import Annotated

from pydantic import Field

from uvms_core.config import Config

MAP_M = 1e6
"""Half of a flat map's size: beyond a thousand kilometres north-east-down means nothing."""
DEEPEST_M = 12_000.0
"""Deeper than the sea is anywhere (10,935 m, Challenger Deep)."""
Coordinate = Annotated[float, Field(ge=-MAP_M, le=MAP_M)]
"""North or east in map_ned, m."""
Depth = Annotated[float, Field(ge=0.0, le=DEEPEST_M)]
"""Below the surface, m: in the air there is no buoyancy to model."""


class StartConfig(Config):
    """Base of the configurations of plant and navigation filter, which must agree on the start."""

    initial_position_m: tuple[Coordinate, Coordinate, Depth] = Field(
        (0.0, 0.0, 10.0),
        description="where the body origin starts in map_ned, m; the navigation filter takes the "
        "depth from the first pressure sample",
    )
