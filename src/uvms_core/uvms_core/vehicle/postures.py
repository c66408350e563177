"""Joint angles as a user gives them: a posture by name, one value a joint, or values by name."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from uvms_core.errors import ConfigError

if TYPE_CHECKING:
    from uvms_core.vehicle.arm import Arm, Joint

STOWED = "stowed"
"""The posture that every vehicle has: `arm.stowed_deg`."""

AnglesDeg = tuple[float, ...] | dict[str, float]
"""Degrees: one value a joint, from the base on, or values by joint name."""

JointAngles = str | AnglesDeg
"""Degrees, or the name of a posture."""


def joint_angles_deg(
    arm: "Arm", angles: JointAngles, others: Sequence[float] | None = None
) -> tuple[float, ...]:
    """All joint angles (n,), degrees.

    Args:
        others: angles (n,), degrees, of the joints that a map leaves out; None: those of `stowed`.

    Raises:
        ConfigError: an unknown posture or joint, or a wrong number of values; lists the choices.
    """
    if isinstance(angles, str):
        return posture_deg(arm, angles)
    if isinstance(angles, Mapping):
        return _by_name(arm.joints, angles, arm.stowed_deg if others is None else others)
    if len(angles) != len(arm.joints):
        names = ", ".join(joint.name for joint in arm.joints)
        raise ConfigError(f"has {len(angles)} values for {len(arm.joints)} joints: {names}")
    return tuple(angles)


def posture_deg(arm: "Arm", name: str) -> tuple[float, ...]:
    """Joint angles (n,) of a posture, degrees; ConfigError for an unknown one."""
    if name == STOWED:
        return arm.stowed_deg
    if name not in arm.postures_deg:
        choices = ", ".join((STOWED, *arm.postures_deg))
        raise ConfigError(
            f"the vehicle has no posture {name!r}; choose one of {choices}, or add it to"
            " arm.postures_deg in the vehicle file"
        )
    return joint_angles_deg(arm, arm.postures_deg[name])


def check_limits(joints: Sequence["Joint"], angles: Sequence[float]) -> None:
    """Raise ConfigError where one of the angles (n,), degrees, is outside its joint's limits."""
    for joint, angle in zip(joints, angles, strict=True):
        if not joint.lower_deg <= angle <= joint.upper_deg:
            raise ConfigError(
                f"{angle:g} of joint {joint.name} is outside its limits"
                f" {joint.lower_deg:g} to {joint.upper_deg:g}"
            )


def _by_name(
    joints: Sequence["Joint"], angles: Mapping[str, float], others: Sequence[float]
) -> tuple[float, ...]:
    names = [joint.name for joint in joints]
    if unknown := [name for name in angles if name not in names]:
        raise ConfigError(f"there is no joint {unknown[0]!r}; the joints are {', '.join(names)}")
    return tuple(angles.get(name, other) for name, other in zip(names, others, strict=True))
