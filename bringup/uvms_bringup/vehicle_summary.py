"""What a vehicle is like: the figures of `uvms vehicle`, as data."""

from typing import Any

import numpy as np

from uvms_control.allocation.authority import axis_authority
from uvms_control.vehicle_data import thruster_limits
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_core.vehicle.plausible.energy import greatest_power_w
from uvms_core.vehicle.plausible.propulsion import (
    AXES,
    axes_out_of_reach,
    axes_pushed_one_way,
    terminal_speed,
)
from uvms_core.vehicle.plausible.stability import postures
from uvms_core.vehicle.postures import STOWED
from uvms_core.vehicle.resistance import axis_resistance
from uvms_core.vehicle.statics import buoyancy, equilibrium, joint_loads, worst_joint_loads
from uvms_dynamics import thruster_matrix
from uvms_dynamics.geometry import OWN, build_geometry, clearances
from uvms_dynamics.model.floating import natural_periods

SAMPLES = 500
"""Postures that are tried for the greatest load of the joints, evenly over their ranges."""


def vehicle_summary(vehicle: Vehicle) -> dict[str, Any]:
    """Plain data for people and scripts; names carry units, lists are in the file's order."""
    state = buoyancy(vehicle)
    return {
        "name": vehicle.name,
        "mass_kg": state.mass_kg,
        "displaced_kg": state.displaced_kg,
        "net_buoyancy_n": -state.net_weight_n,
        "hull": _body(vehicle.hull),
        "links": {link.name: _body(link) for link in vehicle.arm.links},
        "floating": {name: _floating(vehicle, q) for name, q in postures(vehicle)},
        "clearance": _clearance(vehicle),
        "periods_s": _periods(vehicle),
        "thrusters": {
            thruster.name: {
                "limits_n": [thruster.astern_n, thruster.ahead_n],
                "least_n": list(thruster.least_n),
                "dead_zone": thruster.dead_zone,
            }
            for thruster in vehicle.thrusters
        },
        "authority": _authority(vehicle),
        "axes_out_of_reach": list(axes_out_of_reach(vehicle)),
        "axes_pushed_one_way": list(axes_pushed_one_way(vehicle)),
        "speed_m_s": _speeds(vehicle),
        "electrical": _electrical(vehicle),
        "joints": _joints(vehicle),
        "sensors": {
            name: {"rate_hz": sensor.rate_hz, "position_m": list(sensor.position_m)}
            for name, sensor in vehicle.sensors.mounted.items()
        },
    }


def _body(body: Any) -> dict[str, Any]:
    return {
        "mass_kg": body.mass_kg,
        "volume_m3": body.volume_m3,
        "density_kg_m3": body.mass_kg / body.volume_m3,
        "cg_m": list(body.cg_m),
        "cb_m": list(body.cb_m),
    }


def _floating(vehicle: Vehicle, q: Array) -> dict[str, float]:
    rest = equilibrium(vehicle, q)
    return {
        "roll_deg": rest.roll_deg,
        "pitch_deg": rest.pitch_deg,
        "righting_nm_per_deg": rest.righting_nm_per_deg,
        "metacentric_height_m": rest.metacentric_height_m,
    }


def _clearance(vehicle: Vehicle) -> dict[str, dict[str, Any]]:
    """Least distance of arm, hull and links in each posture, m, and between which two.

    Empty where no two bodies of the vehicle could touch.
    """
    geometry = build_geometry(vehicle)
    own = [k for k, pair in enumerate(geometry.pairs) if pair.kind in OWN]
    found = {}
    for name, q in postures(vehicle) if own else ():
        values = clearances(geometry, np.concatenate([np.zeros(4), q]))
        least = min(own, key=values.__getitem__)
        found[name] = {"least_m": float(values[least]), "pair": str(geometry.pairs[least])}
    return found


def _periods(vehicle: Vehicle) -> dict[str, float]:
    periods = natural_periods(vehicle, _stowed(vehicle))
    return {"roll": periods.roll_s, "pitch": periods.pitch_s}


def _stowed(vehicle: Vehicle) -> Array:
    return dict(postures(vehicle))[STOWED]


def _authority(vehicle: Vehicle) -> dict[str, list[float]]:
    """Greatest force, N, or moment, N m, along each axis alone, backwards and forwards."""
    matrix = thruster_matrix(vehicle)
    limits, _ = thruster_limits(vehicle)
    ahead, astern = axis_authority(matrix, limits), axis_authority(-matrix, limits)
    return {axis: [-float(astern[k]), float(ahead[k])] for k, axis in enumerate(AXES)}


def _speeds(vehicle: Vehicle) -> dict[str, float]:
    """Speed of the hull at the full thrust along one axis, without the drag of the arm."""
    forces, density = _authority(vehicle), vehicle.environment.water_density_kg_m3
    linear, quadratic = axis_resistance(vehicle.hull, density)
    return {
        axis: terminal_speed(forces[axis][1], float(linear[k]), float(quadratic[k]))
        for k, axis in enumerate(AXES[:3])
    }


def _electrical(vehicle: Vehicle) -> dict[str, Any]:
    """Power of the loads, W, and what the battery holds, Wh; `lacks`: why that is not known."""
    if vehicle.electrical is None or vehicle.lacks_power:
        return {"lacks": vehicle.lacks_power}
    hotel, battery = vehicle.electrical.hotel_load_w, vehicle.battery
    known = {"hotel_load_w": hotel, "full_thrust_w": greatest_power_w(vehicle) - hotel}
    if battery is None:
        return known
    at_rest = {"lasts_at_rest_h": battery.energy_wh / hotel} if hotel else {}
    return known | {"battery_wh": battery.energy_wh, "battery_ah": battery.charge_ah} | at_rest


def _joints(vehicle: Vehicle) -> dict[str, dict[str, float]]:
    """Greatest static torque in the file's postures, level, and in any posture and attitude."""
    level = np.max([np.abs(joint_loads(vehicle, q)) for _, q in postures(vehicle)], axis=0)
    worst = np.max([worst_joint_loads(vehicle, q) for q in _sampled(vehicle)], axis=0)
    return {
        joint.name: {
            "static_torque_nm": float(level[i]),
            "static_torque_anywhere_nm": float(worst[i]),
            "effort_limit_nm": joint.effort_limit_nm,
            "brake_nm": joint.brake_nm,
        }
        for i, joint in enumerate(vehicle.arm.joints)
    }


def _sampled(vehicle: Vehicle) -> Array:
    """Postures (k, n), rad: those of the file, then some that fill the joints' ranges evenly.

    Multiples of the square roots of integers fill a cube evenly (Weyl).
    """
    lower, upper = joint_limits(vehicle)
    steps = np.sqrt(np.arange(2.0, 2.0 + len(lower)))
    part = np.outer(np.arange(1, SAMPLES + 1), steps) % 1.0
    return np.vstack([[q for _, q in postures(vehicle)], lower + part * (upper - lower)])
