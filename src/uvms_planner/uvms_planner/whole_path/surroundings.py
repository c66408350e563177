"""What a vehicle's thrusters and the bodies around it mean for a plan."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix
from uvms_dynamics.geometry import Geometry
from uvms_planner.whole_path.sample import NO_SURROUNDINGS, Surroundings

THRUST_FRACTION = 0.8  # of each thruster that a plan may need; the rest is the controller's


def surroundings(
    vehicle: Vehicle,
    geometry: Geometry | None = None,
    margins: Array | None = None,
    current: Array | None = None,
    health: Array | None = None,
    fraction: float = THRUST_FRACTION,
) -> Surroundings:
    """Thrust of a vehicle, and its clearances where a geometry with margins (pairs,) m is given.

    current (3,) m/s in map_ned; health (thrusters,) what each thruster has left, 0 to 1.
    """
    none = NO_SURROUNDINGS
    return Surroundings(
        thrust_shares(vehicle, health, fraction),
        none.current if current is None else np.array(current, dtype=float),
        none.shapes if geometry is None else geometry.shapes,
        none.margins if margins is None else np.array(margins, dtype=float),
    )


def thrust_shares(vehicle: Vehicle, health: Array | None = None, fraction: float = 1.0) -> Array:
    """Share (thrusters, 6) of `fraction` of each thruster's limit per unit of a wrench.

    The weaker direction of a thruster that reverses counts. They are the least squares of all
    shares, W B^T (B W B^T)^+ (Fossen 2021, sec. 11.2); what no thruster gives does not count.
    """
    astern = np.array([-thruster.astern_n for thruster in vehicle.thrusters])
    ahead = np.array([thruster.ahead_n for thruster in vehicle.thrusters])
    limits = np.where(astern > 0.0, np.minimum(astern, ahead), ahead)
    limits = limits * (1.0 if health is None else np.asarray(health, dtype=float))
    scaled = thruster_matrix(vehicle) * limits
    able = limits > 0.0
    shares = np.zeros((len(limits), 6))
    shares[able] = np.linalg.pinv(scaled[:, able], rcond=1e-6) / fraction
    return shares
