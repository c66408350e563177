"""The arm: a serial chain of revolute joints, placed by Denavit-Hartenberg fields or as in URDF."""

from typing import Annotated, Any

from pydantic import Field, model_validator

from uvms_core.errors import ConfigError
from uvms_core.vehicle.box import Capsule
from uvms_core.vehicle.parts import (
    AddedMass,
    Inertia,
    Part,
    UnitVector,
    Vector3,
    or_keyword,
    unique_names,
)
from uvms_core.vehicle.postures import STOWED, AnglesDeg, check_limits, joint_angles_deg


class Mounting(Part):
    """Position and orientation of a frame in another one."""

    position_m: Vector3 = Field(description="position of the frame's origin, m")
    rpy_deg: Vector3 = Field(default=(0.0, 0.0, 0.0), description="roll, pitch, yaw (ZYX), degrees")


DH_FIELDS = ("a_m", "alpha_deg", "d_m")


class Joint(Part):
    """A revolute joint about z: placement (DH fields or an `origin`), limits, drive and friction.

    DH: the link's frame is Rz(theta + offset) Tz(d) Tx(a) Rx(alpha) in the previous link's, so its
    origin is at the link's far end. With an `origin`, as in URDF: the link's frame is
    origin Rz(theta + offset) in the previous link's, so its origin is on the link's own joint.
    """

    name: str = Field(min_length=1, description="name of the joint in messages, logs and overrides")
    a_m: float | None = Field(default=None, description="DH link length, m")
    alpha_deg: float | None = Field(default=None, description="DH twist, degrees")
    d_m: float | None = Field(default=None, description="DH offset along the joint axis, m")
    origin: Mounting | None = Field(
        default=None,
        description="instead of the DH fields: pose of the joint in the previous link's frame at"
        " angle zero",
    )
    offset_deg: float = Field(default=0.0, description="rotation about z at angle zero, degrees")
    lower_deg: float = Field(description="lower limit, degrees")
    upper_deg: float = Field(description="upper limit, degrees")
    rate_limit_deg_s: float = Field(gt=0.0, description="largest joint rate, degrees/s")
    acceleration_limit_deg_s2: float = Field(
        gt=0.0, description="largest joint acceleration, degrees/s^2"
    )
    effort_limit_nm: float = Field(gt=0.0, description="largest torque of the drive, N m")
    rotor_inertia_kg_m2: float = Field(
        gt=0.0, description="inertia of motor and gear, reflected to the joint, kg m^2"
    )
    viscous_friction_nm_s: float = Field(ge=0.0, description="viscous friction, N m per rad/s")
    coulomb_friction_nm: float = Field(ge=0.0, description="sliding (Coulomb) friction, N m")
    coulomb_width_deg_s: float = Field(
        gt=0.0, description="rate w of the smooth sliding friction tanh(rate / w), degrees/s"
    )
    brake_nm: float = Field(
        default=0.0,
        ge=0.0,
        description="holding torque of the brake, N m, which engages where the joint has no command"
        " and is released by one; 0: there is none, and the joint swings freely",
    )
    stop_stiffness_nm_rad: float = Field(
        ge=0.0, description="stiffness of the end stops, N m per rad"
    )
    stop_dissipation_s_rad: float = Field(
        ge=0.0, description="Hunt-Crossley dissipation of the end stops, s/rad"
    )

    @model_validator(mode="after")
    def _placed_once(self) -> "Joint":
        given = [name for name in DH_FIELDS if getattr(self, name) is not None]
        if self.origin is not None and given:
            raise ValueError(
                f"is placed twice, by origin and by {', '.join(given)}; remove one of them"
            )
        missing = [name for name in DH_FIELDS if name not in given]
        if self.origin is None and missing:
            raise ValueError(
                f"lacks {', '.join(missing)}: a joint needs {', '.join(DH_FIELDS)}"
                " (Denavit-Hartenberg) or an origin (as in URDF)"
            )
        return self

    @model_validator(mode="after")
    def _ordered(self) -> "Joint":
        if not self.lower_deg < self.upper_deg:
            raise ValueError(
                f"lower_deg = {self.lower_deg:g} must be below upper_deg = {self.upper_deg:g}"
            )
        return self


class DragCylinder(Part):
    """A circular cylinder cut into strips for cross-flow drag."""

    center_m: Vector3 = Field(description="center of the cylinder, link frame, m")
    axis: UnitVector = Field(description="direction of the axis, link frame")
    radius_m: float = Field(gt=0.0, description="radius, m")
    length_m: float = Field(gt=0.0, description="length, m")
    stations: int = Field(
        default=3, ge=1, le=50, description="number of Gauss-Legendre points along the axis"
    )
    free_ends: int = Field(
        default=1,
        ge=0,
        le=2,
        description="ends around which the water flows: 1, a link that hangs on the one before it;"
        " 2, a cylinder by itself; 0, one between two bodies that stop the flow around its ends",
    )
    end_effect: float | None = Field(
        default=None,
        gt=0.0,
        le=1.0,
        description="factor on the cross-flow drag of an endless cylinder; none: by length over"
        " diameter and free_ends, after DNV-RP-C205",
    )


CYLINDER: Any = "cylinder"  # the keyword, for fields of any type


class Cylinder(DragCylinder):
    """The cylinder from which every field of a link with the value `cylinder` is computed."""

    axial_added_mass_fraction: float = Field(
        default=0.1,
        ge=0.0,
        description="added mass along the axis as a fraction of the link's mass",
    )


class Link(Part):
    """The body that joint i moves, in its frame i: the distal DH frame, or that of URDF.

    Fields that are not given follow from the section `cylinder`.
    """

    name: str = Field(min_length=1, description="name of the link")
    cylinder: Cylinder | None = Field(
        default=None, description="shape that gives the fields with the value `cylinder`"
    )
    mass_kg: float = Field(gt=0.0, description="dry mass, kg")
    volume_m3: Annotated[float, or_keyword("cylinder")] = Field(
        default=CYLINDER, gt=0.0, description="displaced volume, m^3, or `cylinder`"
    )
    cg_m: Annotated[Vector3, or_keyword("cylinder")] = Field(
        default=CYLINDER, description="center of gravity, m, or `cylinder`: its center"
    )
    cb_m: Annotated[Vector3, or_keyword("cylinder")] = Field(
        default=CYLINDER, description="center of buoyancy, m, or `cylinder`: its center"
    )
    inertia_kg_m2: Annotated[Inertia, or_keyword("cylinder")] = Field(
        default=CYLINDER,
        description="inertia about the center of gravity, link axes, kg m^2: 3 diagonal values, 3"
        " rows or `cylinder`",
    )
    added_mass: Annotated[AddedMass, or_keyword("cylinder")] = Field(
        default=CYLINDER,
        description="added mass about the link frame's origin, SI units: 6 diagonal values, 6 rows"
        " or `cylinder`",
    )
    drag: Annotated[tuple[DragCylinder, ...], or_keyword("cylinder")] = Field(
        default=CYLINDER, description="cylinders with cross-flow drag, or `cylinder`"
    )
    capsules: tuple[Capsule, ...] = Field(
        default=(),
        description="outline that keeps clear of hull, arm and obstacles, link frame; none: the"
        " capsule around the cylinder or each drag cylinder, without one that along the link's"
        " joints, of its volume",
    )


class DragCoefficient(Part):
    """Drag coefficient by the Reynolds number, linear in its logarithm."""

    reynolds: tuple[float, ...] = Field(
        min_length=2, description="Reynolds numbers, increasing, > 0"
    )
    cd: tuple[float, ...] = Field(
        min_length=2, description="coefficient at each Reynolds number, >= 0"
    )

    @model_validator(mode="after")
    def _is_table(self) -> "DragCoefficient":
        if len(self.reynolds) != len(self.cd):
            raise ValueError(
                f"reynolds has {len(self.reynolds)} values, cd has {len(self.cd)}; give one cd each"
            )
        pairs = zip(self.reynolds, self.reynolds[1:], strict=False)
        if self.reynolds[0] <= 0.0 or not all(low < high for low, high in pairs):
            raise ValueError("reynolds must be > 0 and increasing")
        if self.reynolds[-1] > 1e9:
            raise ValueError(f"reynolds must be at most 1e9; the last is {self.reynolds[-1]:g}")
        if min(self.cd) < 0.0:
            raise ValueError("every cd must be >= 0")
        return self


SMOOTH_PLATE = DragCoefficient(
    reynolds=(1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 5e5, 1e6, 3e6, 1e7),
    cd=(1.328, 0.42, 0.1328, 0.042, 0.01328, 0.0042, 0.00188, 0.00299, 0.00317, 0.00283),
)
"""Skin friction of a smooth flat plate by the Reynolds number of its length: Blasius's 1.328 /
sqrt(Re) up to 5e5, where transition begins, then the ITTC 1957 line less Prandtl's 1700 / Re
(Schlichting, Boundary-Layer Theory, ch. 7 and 21). A slender cylinder along the flow has slightly
more.
"""


class Arm(Part):
    """Arm: mounting, joints, the link that each joint moves, and the tool on the last link."""

    base: Mounting = Field(description="pose of the frame of joint 1 in the body frame")
    joints: tuple[Joint, ...] = Field(min_length=1, description="joints, from the base to the tool")
    links: tuple[Link, ...] = Field(min_length=1, description="links; joint i moves link i")
    tool: Mounting = Field(description="pose of the tool in the last link's frame")
    stowed_deg: tuple[float, ...] = Field(
        description="joint angles of the posture `stowed`, in which the vehicle is trimmed, degrees"
    )
    postures_deg: dict[str, AnglesDeg] = Field(
        default_factory=dict,
        description="further postures by name, such as `home`: one angle a joint, or angles by"
        " joint name (other joints as in `stowed`), degrees",
    )
    drag_coefficient: DragCoefficient = Field(
        description="drag coefficient across the axes of all drag cylinders, by the Reynolds number"
        " of the diameter"
    )
    friction_coefficient: DragCoefficient = Field(
        default=SMOOTH_PLATE,
        description="friction coefficient along the axes, on the lateral surface, by the Reynolds"
        " number of the length; that of a smooth plate by default",
    )

    @model_validator(mode="after")
    def _consistent(self) -> "Arm":
        count = len(self.joints)
        for name, values in (("links", self.links), ("stowed_deg", self.stowed_deg)):
            if len(values) != count:
                raise ValueError(f"{name} has {len(values)} entries for {count} joints")
        unique_names(self.joints, "joint")
        unique_names(self.links, "link")
        return self

    @model_validator(mode="after")
    def _postures_are_possible(self) -> "Arm":
        if STOWED in self.postures_deg:
            raise ValueError(f"postures_deg.{STOWED}: give that posture as stowed_deg")
        postures: dict[str, AnglesDeg] = {"stowed_deg": self.stowed_deg}
        postures |= {f"postures_deg.{name}": each for name, each in self.postures_deg.items()}
        for name, angles in postures.items():
            try:
                check_limits(self.joints, joint_angles_deg(self, angles))
            except ConfigError as fault:
                raise ValueError(f"{name}: {fault}") from fault
        return self
