"""Statics of the floating vehicle: weight and buoyancy, equilibrium attitude, load of the joints.

Down is k = (-sin pitch, sin roll cos pitch, cos roll cos pitch) in the body frame. The bodies' wet
weights W_i = (m_i - rho V_i) g have the first moment P = sum (m_i g r_g,i - rho V_i g r_b,i) about
the body origin, and the moment on the vehicle is P x k (Fossen, Handbook of Marine Craft
Hydrodynamics and Motion Control, 2nd ed., sec. 4.1). It vanishes where k is along P: below the
origin the weight must hang. A net weight is taken to be held by a force at the body origin.
"""

import math
from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.arm import Link
from uvms_core.vehicle.frames import Pose, arm_frames, joint_frames
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.vehicle import Vehicle

LEVEL = np.array([0.0, 0.0, 1.0])
"""Down in the body frame of a level vehicle."""


@dataclass(frozen=True)
class Buoyancy:
    """Mass of vehicle and arm, mass of the water that they displace, and the net weight."""

    mass_kg: float
    displaced_kg: float
    net_weight_n: float
    """Weight less buoyancy: negative floats up."""


@dataclass(frozen=True)
class Equilibrium:
    """Where a freely floating vehicle comes to rest with its arm in one posture."""

    roll_deg: float
    pitch_deg: float
    righting_nm_per_deg: float
    """Moment back to the equilibrium for one degree of tilt, N m; 0 where nothing rights it."""
    metacentric_height_m: float
    """Centre of gravity below that of buoyancy along the vertical of the level vehicle, as the
    moment over the weight; negative: the vehicle turns over."""

    @property
    def tilt_deg(self) -> float:
        """Angle from level, degrees."""
        roll, pitch = math.radians(self.roll_deg), math.radians(self.pitch_deg)
        return math.degrees(math.acos(max(-1.0, min(1.0, math.cos(roll) * math.cos(pitch)))))


def buoyancy(vehicle: Vehicle) -> Buoyancy:
    """Masses and net weight of vehicle and arm, all under water."""
    bodies: tuple[Hull | Link, ...] = (vehicle.hull, *vehicle.arm.links)
    environment = vehicle.environment
    mass = sum(body.mass_kg for body in bodies)
    displaced = environment.water_density_kg_m3 * sum(body.volume_m3 for body in bodies)
    return Buoyancy(mass, displaced, (mass - displaced) * environment.gravity_m_s2)


def first_moment(vehicle: Vehicle, q: Array) -> Array:
    """P (3,), N m: first moment of the bodies' weights less their buoyancies; q (n,) rad."""
    return np.sum([moment for _, moment in _wet_bodies(vehicle, q)], axis=0)


def equilibrium(vehicle: Vehicle, q: Array) -> Equilibrium:
    """Equilibrium attitude with the joints held at q (n,), rad."""
    moment = first_moment(vehicle, q)
    size = float(np.linalg.norm(moment))
    weight = buoyancy(vehicle).mass_kg * vehicle.environment.gravity_m_s2
    down = moment / size if size > 0.0 else LEVEL
    return Equilibrium(
        math.degrees(math.atan2(down[1], down[2])),
        math.degrees(math.atan2(-down[0], math.hypot(down[1], down[2]))),
        size * math.sin(math.radians(1.0)),
        float(moment[2]) / weight,
    )


def joint_loads(vehicle: Vehicle, q: Array, down: Array = LEVEL) -> Array:
    """Torque (n,) of weight and buoyancy on each joint, N m, `down` (3,) in the body frame."""
    return np.array([float(lever @ down) for lever in _levers(vehicle, q)])


def worst_joint_loads(vehicle: Vehicle, q: Array) -> Array:
    """The same at its greatest (n,) over all attitudes of the vehicle."""
    return np.array([float(np.linalg.norm(lever)) for lever in _levers(vehicle, q)])


def _levers(vehicle: Vehicle, q: Array) -> list[Array]:
    """Of each joint the vector (3,) whose product with down is its torque.

    The bodies from the joint on have the moment m x k about its origin, m = P - W o, and z the part
    z . (m x k) = (z x m) . k along the axis.
    """
    bodies = _wet_bodies(vehicle, q)[1:]
    levers = []
    for i, (origin, rotation) in enumerate(joint_frames(vehicle.arm, q)):
        moment = sum((p - w * origin for w, p in bodies[i:]), np.zeros(3))
        levers.append(np.cross(rotation[:, 2], moment))
    return levers


def _wet_bodies(vehicle: Vehicle, q: Array) -> list[tuple[float, Array]]:
    """Net weight, N, and first moment (3,), N m, of hull and links."""
    environment = vehicle.environment
    g, density = environment.gravity_m_s2, environment.water_density_kg_m3
    poses: list[Pose] = [(np.zeros(3), np.eye(3)), *arm_frames(vehicle.arm, q)[1:]]
    bodies: tuple[Hull | Link, ...] = (vehicle.hull, *vehicle.arm.links)
    result = []
    for body, (origin, rotation) in zip(bodies, poses, strict=True):
        weight, lift = body.mass_kg * g, density * body.volume_m3 * g
        moment = weight * (origin + rotation @ body.cg_m) - lift * (origin + rotation @ body.cb_m)
        result.append((weight - lift, moment))
    return result


def wrench_reach(vehicle: Vehicle) -> tuple[Array, Array]:
    """Greatest force and moment (6,) backwards and forwards along each body axis, N and N m.

    All thrusters help, other axes get what they get; both are positive, and upper bounds.
    """
    columns = thruster_columns(vehicle)
    ahead = columns * [thruster.ahead_n for thruster in vehicle.thrusters]
    astern = columns * [thruster.astern_n for thruster in vehicle.thrusters]
    return np.maximum(-ahead, -astern).sum(axis=1), np.maximum(ahead, astern).sum(axis=1)


def thruster_columns(vehicle: Vehicle) -> Array:
    """B (6, m): force and moment about the body origin of one newton of each thruster."""
    directions = np.array([thruster.direction for thruster in vehicle.thrusters])
    positions = np.array([thruster.position_m for thruster in vehicle.thrusters])
    return np.hstack([directions, np.cross(positions, directions)]).T
