"""Where a run starts, as the parts that need it agree on it."""

from pydantic import Field

from uvms_core.config import Config


class StartConfig(Config):
    """Base of the configurations of plant and navigation filter, which must agree on the start."""

    initial_position_m: tuple[float, float, float] = Field(
        (0.0, 0.0, 10.0),
        description="where the body origin starts in map_ned, m; the navigation filter takes the "
        "depth from the first pressure sample",
    )
