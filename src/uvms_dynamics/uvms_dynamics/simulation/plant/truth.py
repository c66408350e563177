"""Ground truth of the plant: for logs and reports, never for a node of the loop."""

from dataclasses import dataclass, replace

import numpy as np

from uvms_core.signals import (
    AppliedThrust,
    Array,
    BatteryState,
    DisturbanceBudget,
    JointStates,
    Odometry,
)
from uvms_dynamics.kernels import coupling_wrench, restoring_wrench
from uvms_dynamics.kernels.hull import hull_hydrodynamic_wrench
from uvms_dynamics.kernels.inverse import coupling_wrench_in
from uvms_dynamics.kernels.layout import HULL
from uvms_dynamics.kernels.layout import JOINTS as JOINTS_COUNT
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_dynamics.model.vehicle_table import Model
from uvms_dynamics.simulation.integrator import DEPTH, JOINTS, QUATERNION, VELOCITY
from uvms_dynamics.simulation.tether import tether_wrench
from uvms_dynamics.simulation.water.surroundings import Surroundings


@dataclass(frozen=True)
class PlantTruth:
    """True pose and velocity over ground, joints, disturbance, thrust and battery."""

    odometry: Odometry
    joints: JointStates
    disturbance: DisturbanceBudget
    applied: AppliedThrust
    battery: BatteryState | None  # where a sample is due
    water: Array  # (3,) velocity of the water at the hull's centre of buoyancy, world, m/s

    @property
    def thrust(self) -> Array:
        """Thrust of each thruster, (m,) N."""
        return self.applied.thrust


def true_odometry(stamp: int, state: Array, current: Array) -> Odometry:
    """Pose and velocity over ground of a state of the integrator, without uncertainty."""
    nu = state[VELOCITY:JOINTS].copy()
    nu[:3] += quat_to_matrix(state[QUATERNION:VELOCITY]).T @ current
    zero = np.zeros((6, 6))
    return Odometry(stamp, state[:3].copy(), state[QUATERNION:VELOCITY].copy(), nu, zero, zero)


def true_joints(stamp: int, state: Array, effort: Array) -> JointStates:
    """Joint angles, rates and the torque that the drives apply."""
    n = effort.shape[0]
    q, q_dot = state[JOINTS : JOINTS + n], state[JOINTS + n : JOINTS + 2 * n]
    return JointStates(stamp, q.copy(), q_dot.copy(), effort.copy())


def true_disturbance(
    stamp: int,
    model: Model,
    state: Array,
    rate: Array,
    current: Array,
    tethered: bool,
    moving: Surroundings | None = None,
) -> DisturbanceBudget:
    """What acts on the vehicle besides the thrusters, from the true state and accelerations.

    restoring: eq. (13). coupling: eq. (14)-(15) with the true accelerations, arm in moving water.
    external: the pull of the tether, and what the current does to the hull, the wrench of the water
    moving as it does less that of still water at the same motion over ground,
    W(nu_r, nu_r_dot) - W(nu, nu_dot), W = -(M_A nu_dot + C_A nu + D nu), with the pressure that
    accelerates the water where it does (`moving`).
    `tethered`: whether there is a tether at all.
    """
    n = int(model[HULL, JOINTS_COUNT])
    quat, nu_r, nu_r_dot = state[QUATERNION:VELOCITY], state[VELOCITY:JOINTS], rate[VELOCITY:JOINTS]
    q, q_dot = state[JOINTS : JOINTS + n], state[JOINTS + n : JOINTS + 2 * n]
    q_ddot = rate[JOINTS + n : JOINTS + 2 * n]
    motion = nu_r, nu_r_dot, q, q_dot, q_ddot
    if moving is None:
        external = _current_on_hull(model, quat, nu_r, nu_r_dot, current)
        coupling = coupling_wrench(model, *motion)
    else:
        external = _water_on_hull(model, quat, nu_r, nu_r_dot, moving)
        coupling = coupling_wrench_in(model, moving.wet, moving.tilt, *motion)
    if tethered:
        external += _tether_wrench(model, state, n)
    return DisturbanceBudget(stamp, restoring_wrench(model, quat, q), coupling, external)


def pushed(budget: DisturbanceBudget, state: Array, push: Array | None) -> DisturbanceBudget:
    """The budget with a push (12,) of `integrator.PUSH` among the external wrench."""
    if push is None:
        return budget
    rotation = quat_to_matrix(state[QUATERNION:VELOCITY]).T
    turned = np.concatenate([rotation @ push[:3], rotation @ push[3:6]])
    return replace(budget, external=budget.external + turned + push[6:])


def _tether_wrench(model: Model, state: Array, n: int) -> Array:
    down = quat_to_matrix(state[QUATERNION:VELOCITY])[2]
    return tether_wrench(model, n, state[DEPTH], down)


def _current_on_hull(
    model: Model, quat: Array, nu_r: Array, nu_r_dot: Array, current: Array
) -> Array:
    if not current.any():
        return np.zeros(6)
    drift = quat_to_matrix(quat).T @ current
    nu, nu_dot = nu_r.copy(), nu_r_dot.copy()
    nu[:3] += drift
    nu_dot[:3] -= skew(nu_r[3:]) @ drift
    moving = hull_hydrodynamic_wrench(model, nu_r, nu_r_dot)
    return moving - hull_hydrodynamic_wrench(model, nu, nu_dot)


def _water_on_hull(
    model: Model, quat: Array, nu_r: Array, nu_r_dot: Array, moving: Surroundings
) -> Array:
    """The same in water that is accelerated and differs from place to place."""
    to_body, omega = quat_to_matrix(quat).T, nu_r[3:]
    drift, orbit = to_body @ moving.velocity, to_body @ moving.orbital[:3]
    pull, orbit_rate = to_body @ moving.acceleration, to_body @ moving.orbital[3:]
    ground, ground_rate = nu_r.copy(), nu_r_dot.copy()
    ground[:3] += drift
    ground_rate[:3] += pull - np.cross(omega, drift)
    flow, flow_rate = nu_r.copy(), nu_r_dot.copy()
    flow[:3] -= orbit
    flow_rate[:3] -= orbit_rate - np.cross(omega, orbit)
    pressure = moving.hull[0] * (pull + orbit_rate)
    wrench = np.concatenate([pressure, np.cross(moving.hull[1:], pressure)])
    wrench += hull_hydrodynamic_wrench(model, flow, flow_rate)
    return wrench - hull_hydrodynamic_wrench(model, ground, ground_rate)
