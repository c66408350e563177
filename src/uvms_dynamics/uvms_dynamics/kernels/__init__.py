"""Numba kernels over the flat tables of a `Model`; each has a numpy reference."""

from uvms_dynamics.kernels import compile_cache  # first: it sets where numba keeps machine code
from uvms_dynamics.kernels.chain import end_effector, end_effector_jacobian, restoring_wrench
from uvms_dynamics.kernels.forward import forward_dynamics
from uvms_dynamics.kernels.hull import hull_bias_wrench
from uvms_dynamics.kernels.inverse import coupling_wrench, inverse_dynamics
from uvms_dynamics.kernels.joints import joint_passive_torque
from uvms_dynamics.kernels.mass import mass_matrix

__all__ = [
    "compile_cache",
    "coupling_wrench",
    "end_effector",
    "end_effector_jacobian",
    "forward_dynamics",
    "hull_bias_wrench",
    "inverse_dynamics",
    "joint_passive_torque",
    "mass_matrix",
    "restoring_wrench",
]
