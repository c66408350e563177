"""Vehicle, kinematics, dynamics, thrusters, sensors and plant of the vehicle-manipulator system."""

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
from uvms_dynamics.vehicle import Vehicle, dump_vehicle, load_vehicle

__all__ = [
    "Model",
    "Vehicle",
    "build_model",
    "coupling_wrench",
    "dump_vehicle",
    "end_effector",
    "end_effector_jacobian",
    "forward_dynamics",
    "hull_bias_wrench",
    "inverse_dynamics",
    "joint_passive_torque",
    "load_vehicle",
    "mass_matrix",
    "restoring_wrench",
]
