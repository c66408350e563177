"""The paper's equations in plain numpy, body by body over ground, to compare kernels with."""

from uvms_dynamics.numpy_reference.coriolis import body_inertia, coriolis_matrix

__all__ = ["body_inertia", "coriolis_matrix"]
