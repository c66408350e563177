"""Resistance of hull and fins along one axis alone, from which top speeds follow."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.damping import linear_matrix, quadratic_matrix
from uvms_core.vehicle.fins import fin_wrench
from uvms_core.vehicle.hull import Hull


def axis_resistance(hull: Hull, density: float) -> tuple[Array, Array]:
    """Linear and quadratic resistance (6,) to motion along or about each axis alone, SI units.

    Fins count with their drag at the angle at which such a motion meets them. density: of the
    water, kg/m^3.
    """
    quadratic = np.diag(quadratic_matrix(hull)).copy()
    for k, unit in enumerate(np.eye(6)):
        quadratic[k] -= sum(fin_wrench(fin, unit, density)[k] for fin in hull.fins)
    return np.diag(linear_matrix(hull)), quadratic
