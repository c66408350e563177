"""Parameters of the controller and of the thrust allocator, each with unit, bounds and meaning."""

from collections.abc import Mapping
from typing import Any, ClassVar

from pydantic import Field

from uvms_control.allocator_config import AllocatorConfig
from uvms_control.arm_config import ArmControlConfig, CompensationConfig
from uvms_control.interfaces import ControlLaw
from uvms_control.vehicle_config import GainConfig, VehicleControlConfig
from uvms_core import registry
from uvms_core.plugin import PluginConfig, Slot

__all__ = [
    "AllocatorConfig",
    "ArmControlConfig",
    "CompensationConfig",
    "ControlConfig",
    "GainConfig",
    "VehicleControlConfig",
]


class ControlConfig(PluginConfig):
    """Vehicle and arm controller."""

    slot: ClassVar[Slot] = Slot(registry.CONTROLLERS, "law", ControlLaw)
    words: ClassVar[Mapping[str, Mapping[str, Any]]] = {"off": {"enabled": False}}

    law: str = Field(
        default="default",
        description="control law: default (righting moment and damping stay with the hull, gains by"
        " rule), paper (eq. (22) and (19) as printed), that of an installed package, or a class as"
        " my_package.my_module:MyLaw, which may ignore the other fields of this section",
    )
    enabled: bool = Field(
        default=True,
        description="control the vehicle; false leaves it free (zero wrench), the arm still moves",
    )
    observer: bool = Field(
        default=True, description="feed the observed disturbance forward, F_dis of eq. (22)"
    )
    compensate_vehicle_motion: bool = Field(
        default=True,
        description="move the joint reference so that the estimated end effector stays on its path",
    )
    gains: GainConfig = GainConfig()
    vehicle: VehicleControlConfig = VehicleControlConfig()
    arm: ArmControlConfig = ArmControlConfig()
    compensation: CompensationConfig = CompensationConfig()
