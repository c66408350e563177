"""The vehicle without its arm: mass, volume, added mass and damping."""

from typing import Annotated, Any

from pydantic import Field, field_validator

from uvms_core.vehicle.parts import (
    AddedMass,
    Inertia,
    Part,
    Vector3,
    Vector6,
    or_keyword,
    unique_names,
)

SPHEROID: Any = "spheroid"  # keywords, for fields of any type
NEUTRAL: Any = "neutral"


class Spheroid(Part):
    """A prolate spheroid about the x axis, centred at the body origin."""

    length_m: float = Field(gt=0.0, description="length along x, m")
    diameter_m: float = Field(gt=0.0, description="largest diameter, below the length, m")
    roll_added_inertia_fraction: float = Field(
        default=0.3,
        ge=0.0,
        description="added roll inertia (fins, fairings) as a fraction of the displaced water's",
    )

    @field_validator("diameter_m")
    @classmethod
    def _slender(cls, value: float, info) -> float:
        length = info.data.get("length_m")
        if length is not None and value >= length:
            raise ValueError(f"must be below length_m = {length:g} (a prolate spheroid)")
        return value


class Attachment(Part):
    """Equipment fixed to the hull that is given by its weight in water, such as ballast."""

    name: str = Field(min_length=1, description="name of the attachment")
    position_m: Vector3 = Field(description="its center, body frame, m")
    wet_weight_n: float = Field(description="weight minus buoyancy, N; negative: it floats")
    mass_kg: float = Field(
        default=0.0, ge=0.0, description="dry mass, as a point, kg; 0: part of the hull's mass"
    )


class Hull(Part):
    """Hull in the body frame (forward-starboard-down); damping and added mass are positive.

    Fields that are not given follow from the section `spheroid`.
    """

    spheroid: Spheroid | None = Field(
        default=None, description="shape that gives the fields with the value `spheroid`"
    )
    volume_m3: Annotated[float, or_keyword("spheroid")] = Field(
        default=SPHEROID, gt=0.0, description="displaced volume, m^3, or `spheroid`"
    )
    mass_kg: Annotated[float, or_keyword("neutral")] = Field(
        default=NEUTRAL,
        gt=0.0,
        description="dry mass, kg, or `neutral`: vehicle and arm together are neutrally buoyant",
    )
    cg_m: tuple[
        Annotated[float, or_keyword("trim")], Annotated[float, or_keyword("trim")], float
    ] = Field(description="center of gravity, m; x and y may be `trim`: level with the arm stowed")
    cb_m: Vector3 = Field(description="center of buoyancy, m")
    inertia_kg_m2: Annotated[Inertia, or_keyword("spheroid")] = Field(
        default=SPHEROID,
        description="inertia about the center of gravity, body axes, kg m^2: 3 diagonal values, 3"
        " rows or `spheroid`",
    )
    added_mass: Annotated[AddedMass, or_keyword("spheroid")] = Field(
        default=SPHEROID,
        description="added mass about the body origin, SI units: 6 diagonal values, 6 rows or"
        " `spheroid`",
    )
    attachments: tuple[Attachment, ...] = Field(
        default=(), description="ballast, foam, instruments; the loader adds them to the hull"
    )
    linear_damping: Vector6 = Field(
        description="linear damping in X Y Z K M N, N per m/s and N m per rad/s, each >= 0"
    )
    quadratic_damping: Vector6 = Field(
        description="quadratic damping in X Y Z K M N, N per (m/s)^2 and N m per (rad/s)^2,"
        " each >= 0"
    )

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
