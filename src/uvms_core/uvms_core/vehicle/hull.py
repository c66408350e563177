"""The vehicle without its arm: mass, volume, added mass and damping."""

from typing import Annotated, Any

from pydantic import Field, field_validator

from uvms_core.vehicle.box import Box
from uvms_core.vehicle.damping import CrossTerms, Damping
from uvms_core.vehicle.fins import Fin
from uvms_core.vehicle.parts import (
    AddedMass,
    Inertia,
    Part,
    Vector3,
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
    linear_damping: Damping = Field(
        description="linear damping in X Y Z K M N, N per m/s and N m per rad/s: 6 diagonal values"
        " or 6 rows, each value on the diagonal >= 0"
    )
    quadratic_damping: Damping = Field(
        description="quadratic damping in X Y Z K M N, N per (m/s)^2 and N m per (rad/s)^2: 6"
        " diagonal values or 6 rows, each value on the diagonal >= 0; column j is multiplied by"
        " |nu_j| nu_j"
    )
    cross_terms: CrossTerms | None = Field(
        default=None,
        description="products with the surge speed of a slender hull, as they are published; none:"
        " there are none",
    )
    fins: tuple[Fin, ...] = Field(default=(), description="rudders, stern planes and wings")
    boxes: tuple[Box, ...] = Field(
        default=(),
        description="outline that arm and obstacles keep clear of, body frame; none: the spheroid,"
        " without one the cuboid of the hull's inertia. Fins are added as balls",
    )
    speeds_m_s: tuple[float, float] = Field(
        default=(0.0, 3.0),
        description="least and greatest surge speed, m/s, between which damping and cross_terms"
        " must take energy from every motion",
    )

    @field_validator("attachments")
    @classmethod
    def _named_once(cls, value: tuple[Attachment, ...]) -> tuple[Attachment, ...]:
        unique_names(value, "attachment")
        return value

    @field_validator("fins")
    @classmethod
    def _fins_named_once(cls, value: tuple[Fin, ...]) -> tuple[Fin, ...]:
        unique_names(value, "fin")
        return value

    @field_validator("speeds_m_s")
    @classmethod
    def _range(cls, value: tuple[float, float]) -> tuple[float, float]:
        if not 0.0 <= value[0] <= value[1]:
            raise ValueError(f"must be 0 <= least <= greatest; is {value[0]:g}, {value[1]:g}")
        return value
