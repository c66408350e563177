"""Vehicle and arm control, and thrust allocation, for an underwater vehicle with an arm."""

from uvms_control.allocation import ThrustAllocator
from uvms_control.arm_controller import ArmController
from uvms_control.config import (
    AllocatorConfig,
    ArmControlConfig,
    CompensationConfig,
    ControlConfig,
    GainConfig,
    VehicleControlConfig,
)
from uvms_control.controller import Controller
from uvms_control.errors import AllocationError, ControlError, ControlSetupError
from uvms_control.interfaces import AllocationMethod, ControlLaw
from uvms_control.reference import ReferenceSample, sample_reference
from uvms_control.s_surface import SSurface, lyapunov, sigmoid, sigmoid_series
from uvms_control.tracking_error import TrackingError, tracking_error
from uvms_control.vehicle_controller import VehicleController

__all__ = [
    "AllocationError",
    "AllocationMethod",
    "AllocatorConfig",
    "ArmControlConfig",
    "ArmController",
    "CompensationConfig",
    "ControlConfig",
    "ControlError",
    "ControlLaw",
    "ControlSetupError",
    "Controller",
    "GainConfig",
    "ReferenceSample",
    "SSurface",
    "ThrustAllocator",
    "TrackingError",
    "VehicleControlConfig",
    "VehicleController",
    "lyapunov",
    "sample_reference",
    "sigmoid",
    "sigmoid_series",
    "tracking_error",
]
