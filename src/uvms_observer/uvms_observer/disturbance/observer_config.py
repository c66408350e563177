"""Parameters of the disturbance observer."""

from typing import ClassVar

from pydantic import Field

from uvms_core import registry
from uvms_core.checks import MAX_AGE_S
from uvms_core.plugin import PluginConfig, Slot
from uvms_observer.interfaces import ObserverLaw


class ObserverConfig(PluginConfig):
    """What is fed forward, bandwidths of accelerations and external wrench, and limits."""

    slot: ClassVar[Slot] = Slot(registry.OBSERVERS, "law", ObserverLaw)

    law: str = Field(
        "combined",
        description="disturbance observer: combined (eq. (21) by the model, the external wrench by"
        " the momentum residual, and a payload), momentum (without payload), paper (eq. (21)"
        " alone), none (no disturbance), that of an installed package, or a class as"
        " my_package.my_module:MyObserver",
    )
    external: bool = Field(
        True,
        description="feed the external wrench forward as well (current, tether, model error);"
        " it is estimated and published in any case",
    )
    external_bandwidth_rad_s: float | None = Field(
        None,
        gt=0.0,
        le=10.0,
        description="bandwidth of the external wrench's estimate (the gain K of the momentum "
        "residual), rad/s, for all axes; none: by rule for each axis, from the noise of the "
        "sensors, inertia, thrust and the delay of the loop",
    )
    joint_jerk_rad_s3: float | None = Field(
        None,
        gt=0.0,
        description="how much a joint's acceleration changes within one second, rad/s^3; larger "
        "follows faster and lets more encoder noise through; none: by rule, from the noise of the"
        " encoders for a bandwidth of half the highest frequency that the samples can show",
    )
    vehicle_jerk_m_s3: float | None = Field(
        None,
        gt=0.0,
        description="how much the vehicle's acceleration changes within one second, m/s^3; none: by"
        " the same rule from the noise of its velocity",
    )
    vehicle_jerk_rad_s3: float | None = Field(
        None,
        gt=0.0,
        description="how much its angular acceleration changes within one second, rad/s^3; none: by"
        " the same rule from the noise of its rates",
    )
    joint_age_limit_s: float | None = Field(
        None,
        gt=0.0,
        le=MAX_AGE_S,
        description="greatest age of joint states, which are carried to the tick, s; none: by rule,"
        " the delay that the loop has anyhow (thruster lag and one and a half periods)",
    )
