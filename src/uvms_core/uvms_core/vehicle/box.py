"""Boxes and capsules as files give them."""

from typing import Annotated

from pydantic import Field

from uvms_core.vehicle.parts import Part, Vector3

Size = Annotated[float, Field(gt=0.0)]


class Box(Part):
    """A cuboid."""

    center_m: Vector3 = Field(description="center, m")
    size_m: tuple[Size, Size, Size] = Field(description="lengths of its sides, each > 0, m")
    rpy_deg: Vector3 = Field(default=(0.0, 0.0, 0.0), description="roll, pitch, yaw (ZYX), degrees")


class Capsule(Part):
    """All points that are no farther than the radius from a segment."""

    start_m: Vector3 = Field(description="where the segment begins, m")
    end_m: Vector3 = Field(description="where the segment ends, m; a ball where it is the start")
    radius_m: float = Field(gt=0.0, description="radius, m")
