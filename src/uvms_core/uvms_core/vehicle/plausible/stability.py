"""Static stability of the floating vehicle, and the drives and brakes that carry its arm."""

from collections.abc import Iterator

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.plausible.water import NONE
from uvms_core.vehicle.postures import STOWED, posture_deg
from uvms_core.vehicle.statics import equilibrium, joint_loads
from uvms_core.vehicle.vehicle import Vehicle

STOWED_TILT = 10.0
"""Tilt with the arm stowed that a vehicle is usually ballasted to stay within, degrees."""

POSTURE_TILT = 45.0
"""Tilt in another posture, degrees: beyond it the arm turns the vehicle over."""


def check_stability(vehicle: Vehicle) -> Iterator[Finding]:
    """Equilibrium in each posture, and the static torque of each joint there."""
    environment = vehicle.environment
    if min(environment.gravity_m_s2, environment.water_density_kg_m3) <= NONE:
        return
    for name, q in postures(vehicle):
        yield from _equilibrium(vehicle, name, q)
        yield from _loads(vehicle, name, q)


def postures(vehicle: Vehicle) -> Iterator[tuple[str, Array]]:
    """Name and joint angles (n,), rad, of the stowed and all further postures."""
    for name in (STOWED, *vehicle.arm.postures_deg):
        yield name, np.radians(posture_deg(vehicle.arm, name))


def _equilibrium(vehicle: Vehicle, posture: str, q: Array) -> Iterator[Finding]:
    rest = equilibrium(vehicle, q)
    where = f"with the arm in posture {posture}"
    if rest.metacentric_height_m < 0.0:
        yield Finding(
            "hull.cg_m",
            f"{where} the vehicle turns over: its metacentric height is"
            f" {1000.0 * rest.metacentric_height_m:.3g} mm, and must be above 0 for weight to hang"
            " below buoyancy",
        )
        return
    bound = STOWED_TILT if posture == STOWED else POSTURE_TILT
    if rest.tilt_deg > bound:
        yield Finding(
            "hull.cg_m",
            f"{where} the vehicle floats at {rest.roll_deg:.3g} degrees of roll and"
            f" {rest.pitch_deg:.3g} of pitch, tilted more than {bound:g}: weight and buoyancy are"
            " not above one another at level",
        )


def _loads(vehicle: Vehicle, posture: str, q: Array) -> Iterator[Finding]:
    loads = np.abs(joint_loads(vehicle, q))
    for number, (joint, load) in enumerate(zip(vehicle.arm.joints, loads, strict=True)):
        limits = {"effort_limit_nm": joint.effort_limit_nm}
        if joint.brake_nm:
            limits["brake_nm"] = joint.brake_nm
        for field, limit in limits.items():
            if load > limit:
                what = "drive" if field.startswith("effort") else "brake"
                yield Finding(
                    f"arm.joints.{number}.{field}",
                    f"{limit:g} N m are below the {load:.3g} N m of weight and buoyancy at joint"
                    f" {joint.name} in posture {posture}, level: the {what} cannot hold it",
                )
