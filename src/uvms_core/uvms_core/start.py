"""Where a run starts, as the parts that need it agree on it."""

from typing import Annotated

from pydantic import Field

from uvms_core.config import Config

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
"""A place in map_ned, m: the map is a plane, which no vehicle leaves by a thousand kilometres."""


Depth = Annotated[float, Field(ge=0.0, le=12_000.0)]
"""Below the surface, m: in the air there is no buoyancy to model; no sea is deeper."""


class StartConfig(Config):
    """Base of the configurations of plant and navigation filter, which must agree on the start."""

    initial_position_m: tuple[Coordinate, Coordinate, Depth] = Field(
        (0.0, 0.0, 10.0),
        description="where the body origin starts in map_ned, m; the navigation filter takes the "
        "depth from the first pressure sample",
    )
