"""Joint drives: limits and friction that no motor has."""

from collections.abc import Iterator

from uvms_core.vehicle.arm import Joint
from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.vehicle import Vehicle

MOST = {
    "effort_limit_nm": (1e4, "the largest underwater manipulators have some thousand N m"),
    "rate_limit_deg_s": (720.0, "two turns a second: water would tear the arm off"),
    "acceleration_limit_deg_s2": (1e4, "no drive turns an arm in water so fast"),
    "rotor_inertia_kg_m2": (1e3, "a motor of tons, seen through its gear"),
    "viscous_friction_nm_s": (1e4, "the joint could not turn"),
    "stop_stiffness_nm_rad": (1e7, "stiffer than the links"),
}
"""Bounds of a joint's fields, and why."""


def check_drives(vehicle: Vehicle) -> Iterator[Finding]:
    """Limits, inertia and friction of the joints; warnings, since the simulation takes them."""
    for joint in vehicle.arm.joints:
        path = f"arm.joints.{joint.name}"
        for field, (most, why) in MOST.items():
            value = getattr(joint, field)
            if value > most:
                yield Finding(f"{path}.{field}", f"{value:g} is more than {most:g}; {why}")
        yield from _stuck(path, joint)


def _stuck(path: str, joint: Joint) -> Iterator[Finding]:
    if joint.coulomb_friction_nm >= joint.effort_limit_nm:
        yield Finding(
            f"{path}.coulomb_friction_nm",
            f"{joint.coulomb_friction_nm:g} N m, not less than the drive's effort_limit_nm ="
            f" {joint.effort_limit_nm:g}; the joint cannot move",
        )
