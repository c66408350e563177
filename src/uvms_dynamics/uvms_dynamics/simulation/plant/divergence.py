"""The error of a plant with a state that is no longer finite."""

import numpy as np

from uvms_core.errors import PlantDiverged
from uvms_core.signals import Array, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.plant.operating_points import AXES


def check_finite(vehicle: Vehicle, step: float, stamp: int, states: Array, rates: Array) -> None:
    """Raise PlantDiverged where a state or its rate is not finite; names time, step and quantity.

    states and rates (k, nx) are those of the integrator, `step` s apart; the last is at `stamp`.
    """
    if np.isfinite(states[-1]).all() and np.isfinite(rates[-1]).all():
        return
    row = int(np.argmin(np.isfinite(states).all(axis=1) & np.isfinite(rates).all(axis=1)))
    what, table = ("", states) if not np.isfinite(states[row]).all() else ("derivative of ", rates)
    fastest = np.abs(rates[row - 1] if row else states[0])  # of several, the fastest
    k = int(np.argmax(np.where(np.isfinite(table[row]), -1.0, fastest)))
    time = to_seconds(stamp) - (len(states) - 1 - row) * step
    then = f"; {step:g} s before it was {table[row - 1, k]:.3g}" if row else ""
    raise PlantDiverged(
        f"the plant diverged at t = {time:.3f} s with step_s = {step:g} s:"
        f" {what}{quantities(vehicle)[k]} is {table[row, k]:g}{then}"
    )


def quantities(vehicle: Vehicle) -> list[str]:
    """Names and units of the integrator's state (nx,)."""
    joints = [joint.name for joint in vehicle.arm.joints]
    return [
        *(f"position {axis} [m]" for axis in ("north", "east", "down")),
        *(f"quaternion {part}" for part in "xyzw"),
        *(f"velocity in {axis} [m/s]" for axis in AXES[:3]),
        *(f"rate of {axis} [rad/s]" for axis in AXES[3:]),
        *(f"angle of joint {name} [rad]" for name in joints),
        *(f"rate of joint {name} [rad/s]" for name in joints),
        *(f"thrust of {thruster.name} [N]" for thruster in vehicle.thrusters),
    ]
