"""Dynamics of an underwater vehicle with an arm: rigid bodies, water, simulation."""

from typing import Any

from uvms_core.moved import moved
from uvms_dynamics.kernels import (
    coupling_wrench,
    end_effector,
    end_effector_jacobian,
    forward_dynamics,
    hull_bias_wrench,
    inverse_dynamics,
    joint_passive_torque,
    mass_matrix,
    restoring_wrench,
)
from uvms_dynamics.kernels.rotations import (
    matrix_to_quat,
    quat_conjugate,
    quat_multiply,
    quat_normalize,
    quat_to_matrix,
    quat_to_rotation_vector,
    quat_to_rpy,
    rotation_vector_to_quat,
    rpy_to_quat,
    skew,
)
from uvms_dynamics.model import Model, build_model, configuration_matrix, thruster_matrix

__all__ = [
    "Model",
    "build_model",
    "configuration_matrix",
    "coupling_wrench",
    "end_effector",
    "end_effector_jacobian",
    "forward_dynamics",
    "hull_bias_wrench",
    "inverse_dynamics",
    "joint_passive_torque",
    "mass_matrix",
    "matrix_to_quat",
    "quat_conjugate",
    "quat_multiply",
    "quat_normalize",
    "quat_to_matrix",
    "quat_to_rotation_vector",
    "quat_to_rpy",
    "restoring_wrench",
    "rotation_vector_to_quat",
    "rpy_to_quat",
    "skew",
    "thruster_matrix",
]

_MOVED = {
    "Vehicle": "uvms_core.vehicle",
    "dump_vehicle": "uvms_core.vehicle",
    "load_vehicle": "uvms_core.vehicle",
    "generator": "uvms_core.rng",
    "signals": "uvms_core",
    "topics": "uvms_core",
    "diagnostics": "uvms_core",
    "compile_cache": "uvms_dynamics.kernels",
    "Plant": "uvms_dynamics.simulation",
    "PlantConfig": "uvms_dynamics.simulation",
    "PlantTruth": "uvms_dynamics.simulation",
    "SensorFrame": "uvms_dynamics.simulation",
    "System": "uvms_dynamics.simulation",
    "advance_batch": "uvms_dynamics.simulation",
    "build_thrusters": "uvms_dynamics.simulation",
    "make_state": "uvms_dynamics.simulation",
    "make_system": "uvms_dynamics.simulation",
    "simulate": "uvms_dynamics.simulation",
}
"""Names that had their home here until version 0.2, and where it is now."""


def __getattr__(name: str) -> Any:
    return moved(__name__, name, _MOVED)
