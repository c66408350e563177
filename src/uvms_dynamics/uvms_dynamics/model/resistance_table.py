"""The hull's damping and fins as the kernels read them."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Environment, Hull
from uvms_core.vehicle.damping import lift_matrix, linear_matrix, quadratic_matrix
from uvms_core.vehicle.fins import fin_table
from uvms_dynamics.kernels.layout import FIN_NUMBERS


def damping_matrices(hull: Hull) -> Array:
    """(3, 6, 6): linear, quadratic, products with the surge speed; (0, 6, 6) if all is diagonal."""
    matrices = np.array([linear_matrix(hull), quadratic_matrix(hull), lift_matrix(hull)])
    off = matrices[:2] * (1.0 - np.eye(6))
    return matrices if off.any() or matrices[2].any() else matrices[:0]


def fin_numbers(hull: Hull, environment: Environment) -> Array:
    """(fins, FIN_NUMBERS): the columns `FIN` of the layout."""
    density = environment.water_density_kg_m3
    rows = [np.hstack([np.atleast_1d(x) for x in fin_table(fin, density)]) for fin in hull.fins]
    return np.array(rows).reshape(-1, int(FIN_NUMBERS))
