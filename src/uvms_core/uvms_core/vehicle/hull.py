"""The vehicle without its arm: mass, volume, added mass and damping."""

from typing import Annotated, Any

from pydantic import Field, field_validator

from uvms_core.vehicle.parts import (
    AddedMass,
    Inertia,
    Part,
    Vector3,
    Vector6,
    unique_names,
    word,
)

SPHEROID: Any = "spheroid"  # the words, of any field's type
NEUTRAL: Any = "neutral"


class Spheroid(Part):
    """A prolate spheroid about the x axis, centred at the body origin."""

    length_m: float = Field(gt=0.0, description="length along x, m")
    diameter_m: float = Field(gt=0.0, description="greatest diameter, m; below the length")
    roll_added_inertia_fraction: float = Field(
        default=0.3,
        ge=0.0,
        description="added roll inertia (fins, fairings) as a part of the displaced water's",
    )

    @field_validator("diameter_m")
    @classmethod
    def _slender(cls, value: float, info) -> float:
        length = info.data.get("length_m")
        if length is not None and value >= length:
            raise ValueError(f"must be below length_m = {length:g} (a prolate spheroid)")
        return value


class Attachment(Part):
    """Something fixed to the hull that is given by its weight in the water, such as ballast."""

    name: str = Field(min_length=1, description="what it is")
    position_m: Vector3 = Field(description="of its centre, body frame, m")
    wet_weight_n: float = Field(description="weight less buoyancy, N; below zero it floats")
    mass_kg: float = Field(
        default=0.0, ge=0.0, description="dry mass, kg, a point; 0: the hull's mass counts it"
    )


class Hull(Part):
    """Hull in the body frame (forward-starboard-down); damping and added mass are positive.

    What is not said of its shape follows from the section `spheroid`.
    """

    spheroid: Spheroid | None = Field(
        default=None, description="shape behind every field that says `spheroid`"
    )
    volume_m3: Annotated[float, word("spheroid")] = Field(
        default=SPHEROID, gt=0.0, description="displaced volume, m^3, or `spheroid`"
    )
    mass_kg: Annotated[float, word("neutral")] = Field(
        default=NEUTRAL,
        gt=0.0,
        description="dry mass, kg, or `neutral`: vehicle and arm displace their own mass",
    )
    cg_m: tuple[Annotated[float, word("trim")], Annotated[float, word("trim")], float] = Field(
        description="centre of gravity, m; x and y may be `trim`: level with the arm stowed"
    )
    cb_m: Vector3 = Field(description="centre of buoyancy, m")
    inertia_kg_m2: Annotated[Inertia, word("spheroid")] = Field(
        default=SPHEROID,
        description="about the CG, body axes, kg m^2: 3 diagonal values, 3 rows or `spheroid`",
    )
    added_mass: Annotated[AddedMass, word("spheroid")] = Field(
        default=SPHEROID,
        description="about the body origin, SI: 6 diagonal values, 6 rows or `spheroid`",
    )
    attachments: tuple[Attachment, ...] = Field(
        default=(), description="ballast, foam, instruments; the loader makes them part of the hull"
    )
    linear_damping: Vector6 = Field(description="N per m/s and N m per rad/s, each >= 0")
    quadratic_damping: Vector6 = Field(description="N per (m/s)^2 and N m per (rad/s)^2, each >= 0")

    @field_validator("attachments")
    @classmethod
    def _named_once(cls, value: tuple[Attachment, ...]) -> tuple[Attachment, ...]:
        unique_names(value, "attachment")
        return value

    @field_validator("linear_damping", "quadratic_damping")
    @classmethod
    def _dissipates(cls, value: Vector6) -> Vector6:
        if min(value) < 0.0:
            raise ValueError("damping is written positive: every value must be >= 0")
        return value
