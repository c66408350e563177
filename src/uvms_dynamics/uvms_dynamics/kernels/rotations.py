"""The functions of `uvms_core.rotations`, compiled: for kernels, and faster from Python."""

from uvms_core import rotations
from uvms_dynamics.kernels.jit import exact_kernel as _compiled

skew = _compiled(rotations.skew)
quat_multiply = _compiled(rotations.quat_multiply)
quat_conjugate = _compiled(rotations.quat_conjugate)
quat_normalize = _compiled(rotations.quat_normalize)
quat_to_matrix = _compiled(rotations.quat_to_matrix)
matrix_to_quat = _compiled(rotations.matrix_to_quat)
rotation_vector_to_quat = _compiled(rotations.rotation_vector_to_quat)
quat_to_rotation_vector = _compiled(rotations.quat_to_rotation_vector)
rpy_to_quat = _compiled(rotations.rpy_to_quat)
quat_to_rpy = _compiled(rotations.quat_to_rpy)
