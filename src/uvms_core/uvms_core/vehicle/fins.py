"""Fins of the hull: rudders, stern planes and wings with lift, drag and stall.

The section of a fin lies in the plane of `chord` and `normal`; what flows along the span is left
out. With the local velocity (a, n) of the fin through the water along chord and normal, U its size
and s = n / U the sine of the angle of attack, the force per 1/2 rho S U^2 is

    lift   across the flow   C_L = (1 - f) C_La s c
    drag   against the flow  C_D = C_D0 + C_L^2 / (0.9 pi AR)
    plate  along the normal  C_N = f C_90 s

f(s) is the part of the flow that has separated, 0 at small angles, 1/2 at the stall angle and 1
far beyond: the blend of a wing and a flat plate that Beard and McLain use (Small Unmanned Aircraft,
2012, sec. 4.2.1), here with x^4 / (1 + x^4), x = (s / sin stall)^2. It holds in every direction of
flow, astern as well. Lift does no work; drag and plate take energy from every motion.
"""

import math
from typing import NamedTuple

import numpy as np
from pydantic import Field, model_validator

from uvms_core.signals import Array
from uvms_core.vehicle.parts import Part, UnitVector, Vector3

SECTION_SLOPE = 0.9
"""Lift slope of a real section over the 2 pi of thin-airfoil theory (Hoerner 1965)."""

SPAN_EFFICIENCY = 0.9
"""Induced drag of an elliptic wing over that of a fin (Whicker and Fehlner 1958, DTMB 933)."""

PERPENDICULAR = 1e-3
"""Cosine between chord and normal that counts as the rounding of print."""


class Fin(Part):
    """A fixed fin on the hull; two opposite rudders are two fins."""

    name: str = Field(min_length=1, description="name of the fin")
    position_m: Vector3 = Field(
        description="its center of pressure, about a quarter of the chord behind its leading edge,"
        " body frame, m"
    )
    normal: UnitVector = Field(
        description="unit vector across the fin's plane, body frame: [0, 1, 0] for a rudder,"
        " [0, 0, 1] for a wing"
    )
    chord: UnitVector = Field(
        default=(1.0, 0.0, 0.0),
        description="unit vector along the chord to the leading edge, body frame, perpendicular to"
        " the normal",
    )
    area_m2: float = Field(gt=0.0, description="planform area, m^2")
    aspect_ratio: float = Field(
        gt=0.0,
        description="effective aspect ratio: span^2 / area, times 2 for a fin that stands on the"
        " hull, which mirrors it",
    )
    incidence_deg: float = Field(
        default=0.0,
        gt=-45.0,
        lt=45.0,
        description="angle at which the fin is set, which adds to the angle of attack, degrees;"
        " positive: ahead it pushes against `normal`",
    )
    lift_slope: float | None = Field(
        default=None,
        gt=0.0,
        description="lift coefficient for a radian of angle of attack; none: by Hoerner's formula"
        " 1 / (1 / (1.8 pi) + 1 / (pi aspect_ratio))",
    )
    stall_deg: float = Field(
        default=20.0,
        gt=0.0,
        lt=90.0,
        description="angle of attack at which half of the lift is lost, degrees",
    )
    drag_coefficient: float = Field(
        default=0.0065,
        ge=0.0,
        description="of the section along the flow, on the planform area; 0.0065: NACA 0015"
        " (Whicker and Fehlner 1958)",
    )
    plate_drag_coefficient: float = Field(
        default=1.17,
        ge=0.0,
        description="with the flow across the fin; 1.17: a square plate (Hoerner 1965, ch. 3)",
    )

    @model_validator(mode="after")
    def _plane(self) -> "Fin":
        cosine = float(np.dot(self.chord, self.normal))
        if abs(cosine) > PERPENDICULAR:
            raise ValueError(
                f"chord must be perpendicular to normal; the cosine between them is {cosine:.4g}"
            )
        return self

    @property
    def slope(self) -> float:
        """Lift coefficient for a radian: given, or by Hoerner's formula for low aspect ratios."""
        return hoerner_slope(self.aspect_ratio) if self.lift_slope is None else self.lift_slope


def hoerner_slope(aspect_ratio: float) -> float:
    """dC_L/d(alpha) = 1 / (1/(2 pi 0.9) + 1/(pi AR)), per rad.

    Hoerner, Fluid-Dynamic Lift, pg. 3-2, as Prestero (MIT 2001, eq. 4.38) uses it for the REMUS:
    3.12 at an effective aspect ratio of 2.21.
    """
    return 1.0 / (1.0 / (2.0 * math.pi * SECTION_SLOPE) + 1.0 / (math.pi * aspect_ratio))


class FinTable(NamedTuple):
    """Numbers of a fin that its force follows from; vectors (3,) in the body frame."""

    position: Array
    chord: Array  # with the incidence
    normal: Array
    pressure: float  # 1/2 rho S, kg/m
    slope: float  # per rad
    stall: float  # 1 / sin^2 of the stall angle
    drag: float
    induced: float  # 1 / (pi 0.9 AR)
    plate: float


def fin_table(fin: Fin, density: float) -> FinTable:
    """The numbers of a fin in water of a density, kg/m^3."""
    normal = np.array(fin.normal)
    chord = np.array(fin.chord) - normal * float(np.dot(fin.chord, normal))
    chord = chord / np.linalg.norm(chord)
    angle = math.radians(fin.incidence_deg)
    return FinTable(
        np.array(fin.position_m),
        math.cos(angle) * chord - math.sin(angle) * normal,
        math.cos(angle) * normal + math.sin(angle) * chord,
        0.5 * density * fin.area_m2,
        fin.slope,
        1.0 / math.sin(math.radians(fin.stall_deg)) ** 2,
        fin.drag_coefficient,
        1.0 / (math.pi * SPAN_EFFICIENCY * fin.aspect_ratio),
        fin.plate_drag_coefficient,
    )


def fin_wrench(fin: Fin, nu_r: Array, density: float) -> Array:
    """Force and moment (6,) of the water ON a fin, about the body origin, body frame.

    nu_r (6,): velocity of the hull relative to the water, m/s and rad/s.
    """
    table = fin_table(fin, density)
    velocity = nu_r[:3] + np.cross(nu_r[3:], table.position)
    along, across = float(table.chord @ velocity), float(table.normal @ velocity)
    speed = math.hypot(along, across)
    if speed == 0.0:
        return np.zeros(6)
    s, c = across / speed, along / speed
    x = s**2 * table.stall
    separated = x**4 / (1.0 + x**4)
    lift = (1.0 - separated) * table.slope * s * c
    drag = table.drag + lift**2 * table.induced
    pressure = table.pressure * speed**2
    force = pressure * (lift * s - drag * c) * table.chord
    force -= pressure * (lift * c + drag * s + separated * table.plate * s) * table.normal
    return np.concatenate([force, np.cross(table.position, force)])
