"""How far a vehicle would tilt on its way where its thrusters do not act in roll or pitch."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, inverse_dynamics, thruster_matrix
from uvms_dynamics.kernels.rotations import quat_to_matrix, rpy_to_quat
from uvms_planner.problem import VEHICLE
from uvms_planner.segment import Samples

HELD = [0, 1, 2, 5]
"""Forces and the moment about the vertical axis, which the thrusters must give."""
SMALL = 1e-6
"""Of a singular value relative to the greatest: what is below is zero."""
DIFFERENCE = 1e-3  # rad


class Tilt:
    """What the thrusters leave to the righting moment, and what tilt that comes to.

    The moments of roll and pitch that they cannot give while they give the rest turn the vehicle,
    until its weight and buoyancy hold against it. The vehicle's own stiffness is less the faster
    it goes (Munk's moment: Fossen 2021, sec. 6.3.1, C_A nu), and above some speed there is none.
    """

    def __init__(self, vehicle: Vehicle, health: Array) -> None:
        """Health (thrusters,) is what each thruster has left, 0 to 1."""
        B = thruster_matrix(vehicle) * health
        held = np.linalg.pinv(B[HELD], rcond=SMALL)
        self._with_the_rest = B[3:5] @ held  # roll and pitch that come with the forces
        spare = B[3:5] @ (np.eye(B.shape[1]) - held @ B[HELD])
        U, sizes, _ = np.linalg.svd(spare)
        scale = max(float(np.linalg.norm(B[3:5])), np.finfo(float).tiny)
        self._left = U[:, np.concatenate([sizes, np.zeros(2)])[:2] <= SMALL * scale]

    def along(self, model: Model, samples: Samples) -> Array:
        """Roll and pitch (k, 2), rad, along a motion of the level vehicle; infinite where nothing
        holds against it.
        """
        out = np.zeros((len(samples.configuration), 2))
        if not self._left.shape[1]:
            return out
        for i in range(len(out)):
            out[i] = self._at(
                model, samples.configuration[i], samples.rate[i], samples.acceleration[i]
            )
        return out

    def _at(self, model: Model, c: Array, v: Array, a: Array) -> Array:
        level = self._moment(model, np.zeros(2), c, v, a)
        stiffness = np.empty((self._left.shape[1],) * 2)
        for k, direction in enumerate(self._left.T):
            ahead = self._moment(model, DIFFERENCE * direction, c, v, a)
            behind = self._moment(model, -DIFFERENCE * direction, c, v, a)
            stiffness[:, k] = (ahead - behind) / (2 * DIFFERENCE)
        if np.linalg.eigvalsh(stiffness + stiffness.T).min() <= 0.0:
            return np.full(2, np.inf)
        return self._left @ np.linalg.solve(stiffness, -level)

    def _moment(self, model: Model, tilt: Array, c: Array, v: Array, a: Array) -> Array:
        """What is lacking of the moments that would hold roll and pitch `tilt` (2,) on the way."""
        quaternion = rpy_to_quat(tilt[0], tilt[1], c[3])
        R = quat_to_matrix(quaternion)
        nu, nu_dot = np.zeros(6), np.zeros(6)
        nu[3:] = R[2] * v[3]
        nu[:3] = R.T @ v[:3]
        nu_dot[3:] = R[2] * a[3]
        nu_dot[:3] = R.T @ a[:3] - np.cross(nu[3:], nu[:3])
        joints = (part[VEHICLE:].copy() for part in (c, v, a))
        needed = inverse_dynamics(model, quaternion, nu, nu_dot, *joints)[:6]
        return self._left.T @ (needed[3:5] - self._with_the_rest @ needed[HELD])
