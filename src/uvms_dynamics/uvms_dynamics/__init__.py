"""Vehicle, kinematics, dynamics, thrusters, sensors and plant of the vehicle-manipulator system."""

from uvms_dynamics import compile_cache  # first: it says where numba keeps what it compiles
from uvms_dynamics.integrator import System, make_state, make_system
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
from uvms_dynamics.model import Model, build_model
from uvms_dynamics.plant import Plant, PlantConfig, PlantTruth, SensorFrame
from uvms_dynamics.rng import generator
from uvms_dynamics.rotations import (
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
from uvms_dynamics.simulation import advance_batch, simulate
from uvms_dynamics.thrusters import build_thrusters, configuration_matrix, thruster_matrix
from uvms_dynamics.vehicle import Vehicle, dump_vehicle, load_vehicle

__all__ = [
    "Model",
    "Plant",
    "PlantConfig",
    "PlantTruth",
    "SensorFrame",
    "System",
    "Vehicle",
    "advance_batch",
    "build_model",
    "build_thrusters",
    "compile_cache",
    "configuration_matrix",
    "coupling_wrench",
    "dump_vehicle",
    "end_effector",
    "end_effector_jacobian",
    "forward_dynamics",
    "generator",
    "hull_bias_wrench",
    "inverse_dynamics",
    "joint_passive_torque",
    "load_vehicle",
    "make_state",
    "make_system",
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
    "simulate",
    "skew",
    "thruster_matrix",
]
