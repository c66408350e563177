"""The vehicle as the kernels read it, and what follows from its geometry."""

from uvms_dynamics.model.arm_inertia import arm_added_inertia
from uvms_dynamics.model.thruster_matrix import configuration_matrix, thruster_matrix
from uvms_dynamics.model.vehicle_table import Model, build_model

__all__ = [
    "Model",
    "arm_added_inertia",
    "build_model",
    "configuration_matrix",
    "thruster_matrix",
]
