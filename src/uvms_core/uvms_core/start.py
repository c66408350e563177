"""Where a run starts, as the parts that need it agree on it."""

from typing import Annotated

from pydantic import Field

from uvms_core.config import Config

Coordinate = Annotated[float, Field(ge=-1e6, le=1e6)]
"""A place in map_ned, m: the map is a plane, which no vehicle leaves by a thousand kilometres."""


class StartConfig(Config):
    """Base of the configurations of plant and navigation filter, which must agree on the start."""

    initial_position_m: tuple[Coordinate, Coordinate, Coordinate] = Field(
        (0.0, 0.0, 10.0),
        description="where the body origin starts in map_ned, m; the navigation filter takes the "
        "depth from the first pressure sample",
    )
