"""How fast the motion of a vehicle can change: the numbers that bounds of jumps come from.

Newton's law for every axis alone: all that can act along it over the least that it moves.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.plausibility.scale import diagonal, reach_of
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import distal_pose

UNCERTAIN = 2.0
"""Factor on what acts on the vehicle: coefficients of drag and inertia are known to a factor of
about this, and its axes are coupled."""
DRIVEN = 1.1
"""The same for a joint, whose drive has its limit exactly; the vehicle gives way a little."""
CURRENT_M_S = 2.0
"""Water that a vehicle at rest is suddenly in: the strongest tidal streams that vehicles of this
class are used in. What drag does to a vehicle's own speed comes on top, by that speed."""


@dataclass(frozen=True)
class Agility:
    """Greatest accelerations, and what the actuators have; SI units.

    Attributes:
        nu_dot: (6,) of the vehicle along and about its axes.
        q_ddot: (n,) of the joints.
        thrust: (m,) limit of every thruster, in the direction in which it has more.
        wrench: (6,) of all thrusters together along and about every axis.
    """

    nu_dot: Array
    q_ddot: Array
    thrust: Array
    wrench: Array


def agility_of(vehicle: Vehicle) -> Agility:
    """The greatest accelerations of a vehicle."""
    thrust = np.array([thruster.greatest_n for thruster in vehicle.thrusters])
    wrench = _authority(vehicle, thrust)
    return Agility(_nu_dot(vehicle, wrench), _q_ddot(vehicle), thrust, wrench)


def _authority(vehicle: Vehicle, thrust: Array) -> Array:
    places = np.array([thruster.position_m for thruster in vehicle.thrusters])
    directions = np.array([thruster.direction for thruster in vehicle.thrusters])
    moments = np.cross(places, directions)
    return thrust @ np.abs(np.hstack([directions, moments]))


def _nu_dot(vehicle: Vehicle, authority: Array) -> Array:
    """Thrust, a current, the arm's reaction and the restoring moment; a fall with 1 g.

    Munk's moment turns a slender body that is not along the current (Fossen 2021, ch. 10).
    """
    hull, gravity = vehicle.hull, vehicle.environment.gravity_m_s2
    load = authority.copy()
    load[:3] += CURRENT_M_S * diagonal(hull.linear_damping)[:3]
    load[:3] += CURRENT_M_S**2 * diagonal(hull.quadratic_damping)[:3]
    load[3:] += _arm_moment(vehicle) + _restoring_moment(vehicle)
    added = diagonal(hull.added_mass)
    load[3:] += CURRENT_M_S**2 * np.abs(added[[1, 2, 0]] - added[[2, 0, 1]])  # Munk's moment
    inertia = np.concatenate([np.full(3, hull.mass_kg), diagonal(hull.inertia_kg_m2)])
    rates = UNCERTAIN * load / (inertia + added)
    rates[:3] += gravity  # whatever the vehicle really weighs
    return np.asarray(rates)


def _arm_moment(vehicle: Vehicle) -> float:
    """The strongest drive's torque, and the weight of the arm in water at its full reach."""
    sea, arm = vehicle.environment, vehicle.arm
    wet = [link.mass_kg - sea.water_density_kg_m3 * link.volume_m3 for link in arm.links]
    weight = sea.gravity_m_s2 * float(np.sum(np.abs(wet)))
    return max(joint.effort_limit_nm for joint in arm.joints) + weight * reach_of(vehicle)


def _restoring_moment(vehicle: Vehicle) -> float:
    """Weight and buoyancy at their own levers, with the vehicle in any attitude."""
    hull, sea = vehicle.hull, vehicle.environment
    mass, water = hull.mass_kg, sea.water_density_kg_m3 * hull.volume_m3
    lever = mass * np.array(hull.cg_m) - water * np.array(hull.cb_m)
    return float(sea.gravity_m_s2 * np.linalg.norm(lever))


def _q_ddot(vehicle: Vehicle) -> Array:
    """A drive's whole torque on its rotor and its own link; links beyond may give way."""
    arm, gravity = vehicle.arm, vehicle.environment.gravity_m_s2
    rates = []
    for joint, link in zip(arm.joints, arm.links, strict=True):
        origin, turn = distal_pose(joint)
        center = origin + turn @ np.array(link.cg_m)
        about_cg = float((turn @ np.array(link.inertia_kg_m2, float) @ turn.T)[2, 2])
        lever = float(np.hypot(center[0], center[1]))
        inertia = joint.rotor_inertia_kg_m2 + about_cg + link.mass_kg * lever**2
        load = joint.effort_limit_nm + link.mass_kg * gravity * lever
        rates.append(DRIVEN * load / inertia)
    return np.array(rates)
