"""The thrusts that a motion given by formulas takes, with a hull that is unlike the vehicle file's.

By inverse dynamics of the true motion; what the filter's model is wrong by is drawn by the seed.
"""

import numpy as np

from uvms_core.signals import Allocation, to_seconds
from uvms_dynamics import build_model, inverse_dynamics, thruster_matrix

UNLIKE = 0.2
TICK = 0.05
_H = 1e-3


class Thrusts:
    """What the allocator of a vehicle would have commanded; `allocation(stamp)` is that of a tick.

    Args:
        vehicle: the file that the filter has.
        motion: over ground.
        seed: of drag and added mass, each off by up to `unlike`, and of the current's direction.
        current: m/s.
        pull: force (3,) N in map_ned on the vehicle as a function of time, s.
        share: of each thrust that is commanded beyond what is needed, as where one is dead.
    """

    def __init__(self, vehicle, motion, seed=0, unlike=UNLIKE, current=0.3, pull=None, share=1.0):
        rng = np.random.default_rng([seed, 11])
        self._motion, self._pull, self._share = motion, pull, share
        damp, added, quadratic = 1.0 + unlike * rng.uniform(-1.0, 1.0, (3, 6))
        self._model = build_model(other_hull(vehicle, damp, quadratic, added))
        bearing = rng.uniform(0.0, 2.0 * np.pi)
        self._current = current * np.array([np.cos(bearing), np.sin(bearing), 0.0])
        self._q = np.radians(vehicle.arm.stowed_deg)
        self._inverse = np.linalg.pinv(thruster_matrix(vehicle))
        self._ahead = 0.5 * TICK + vehicle.thrusters[0].time_constant_s

    def allocation(self, stamp):
        """At this tick (ns); the lag is made up for."""
        wrench = self.wrench(to_seconds(stamp) + self._ahead)
        thrust = self._share * (self._inverse @ wrench)
        none = np.zeros(6)
        return Allocation(stamp, thrust, wrench, none, np.zeros(len(thrust), bool))

    def wrench(self, t):
        """Of the thrusters, (6,), at t, s."""
        nu, rotation = self._nu(t), self._motion.rotation(t)
        nu_dot = (self._nu(t + _H) - self._nu(t - _H)) / (2.0 * _H)
        none = np.zeros(len(self._q))
        wrench = inverse_dynamics(self._model, rotation.as_quat(), nu, nu_dot, self._q, none, none)[
            :6
        ]
        if self._pull is not None:
            wrench[:3] -= rotation.inv().apply(self._pull(t))
        return wrench

    def _nu(self, t):
        """Velocity through the water and rates, body axes."""
        velocity = self._motion.velocity(t, np.zeros(3))
        through = velocity - self._motion.rotation(t).inv().apply(self._current)
        return np.concatenate([through, self._motion.omega(t)])


def other_hull(vehicle, linear, quadratic, added):
    """The vehicle with these factors (6,) on its hull's damping and added mass."""
    hull = vehicle.hull
    return vehicle.model_copy(
        update={
            "hull": hull.model_copy(
                update={
                    "linear_damping": scaled(hull.linear_damping, linear),
                    "quadratic_damping": scaled(hull.quadratic_damping, quadratic),
                    "added_mass": scaled(hull.added_mass, added),
                }
            )
        }
    )


def scaled(values, factors):
    """A diagonal, or a symmetric matrix, with each row and column by the root of its factor."""
    values = np.array(values, float)
    if values.ndim == 1:
        return tuple(map(float, values * factors))
    root = np.sqrt(factors)
    return tuple(tuple(map(float, row)) for row in root[:, None] * values * root)
