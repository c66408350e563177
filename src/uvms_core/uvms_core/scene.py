"""What stands in the water and a vehicle must keep away from, in map_ned."""

from typing import Annotated

from pydantic import AfterValidator, Field, model_validator

from uvms_core.config import Config
from uvms_core.vehicle.box import Box
from uvms_core.vehicle.parts import Vector3

SEABED = "seabed"
"""Name of the plane that follows from the vehicle file's `environment.seabed_depth_m`."""


class Sphere(Config):
    """A ball."""

    center_m: Vector3 = Field(description="center, map_ned, m")
    radius_m: float = Field(gt=0.0, description="radius, m")


class Obstacle(Config):
    """A body at rest: a sphere or a box."""

    name: str = Field(min_length=1, max_length=100, description="name in messages and summaries")
    sphere: Sphere | None = Field(None, description="the obstacle is a ball")
    box: Box | None = Field(
        None, description="the obstacle is a cuboid; center and turn in map_ned"
    )

    @model_validator(mode="after")
    def _has_one_shape(self) -> "Obstacle":
        given = [word for word in ("sphere", "box") if getattr(self, word) is not None]
        if len(given) != 1:
            has = f"has {' and '.join(given)}" if given else "has neither"
            raise ValueError(f"obstacle {self.name!r} is one of sphere, box; this one {has}")
        if self.name == SEABED:
            raise ValueError(
                f"{SEABED!r} is the plane at environment.seabed_depth_m of the vehicle file;"
                " choose another name"
            )
        return self


def _named_once(obstacles: tuple[Obstacle, ...]) -> tuple[Obstacle, ...]:
    names = [each.name for each in obstacles]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise ValueError(f"names of obstacles must differ; used more than once: {', '.join(twice)}")
    return obstacles


Obstacles = Annotated[tuple[Obstacle, ...], AfterValidator(_named_once)]
"""All obstacles of a scene, by different names."""
