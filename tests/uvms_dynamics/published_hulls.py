"""Hulls of published vehicles, as printed; the arm weighs nothing and feels nothing.

Prestero, Verification of a Six-Degree of Freedom Simulation Model for the REMUS Autonomous
Underwater Vehicle, MIT 2001; uuv_simulator's packages lauv_gazebo (after da Silva et al., MMAR
2007) and eca_a9. Their tables are force coefficients: damping has the other sign here.
"""

import numpy as np

from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data
from uvms_core.vehicle.damping import kirchhoff, lift_matrix, linear_matrix
from uvms_core.vehicle.hull import Hull
from uvms_core.vehicle.shapes import move_to_origin

REMUS_100 = {  # tables 2.2-2.6, 4.1-4.3; its origin is the centre of buoyancy
    "volume_m3": 306.0 / 9.81 / 1030.0,
    "mass_kg": 299.0 / 9.81,
    "cg_m": [0.0, 0.0, 0.0196],
    "cb_m": [0.0, 0.0, 0.0],
    "inertia_kg_m2": [0.177, 3.45, 3.45],
    "added_mass": [
        [0.93, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 35.5, 0.0, 0.0, 0.0, -1.93],
        [0.0, 0.0, 35.5, 0.0, 1.93, 0.0],
        [0.0, 0.0, 0.0, 0.0704, 0.0, 0.0],
        [0.0, 0.0, 1.93, 0.0, 4.88, 0.0],
        [0.0, -1.93, 0.0, 0.0, 0.0, 4.88],
    ],
    "linear_damping": [0.0] * 6,
    "quadratic_damping": [
        [1.62, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 131.0, 0.0, 0.0, 0.0, -0.632],
        [0.0, 0.0, 131.0, 0.0, 0.632, 0.0],
        [0.0, 0.0, 0.0, 0.0013, 0.0, 0.0],
        [0.0, 0.0, -3.18, 0.0, 9.40, 0.0],
        [0.0, 3.18, 0.0, 0.0, 0.0, 9.40],
    ],
    "cross_terms": {
        "Y_uv": -28.6,
        "Y_ur": 5.22,
        "N_uv": -24.0,
        "N_ur": -2.0,
        "Z_uw": -28.6,
        "Z_uq": -5.22,
        "M_uw": 24.0,
        "M_uq": -2.0,
    },
}

LAUV = {
    "volume_m3": 0.017551374956865266,
    "mass_kg": 18.0,
    "cg_m": [0.0, 0.0, 0.01],
    "cb_m": [0.0, 0.0, 0.0],
    "inertia_kg_m2": [0.050625, 1.7748, 1.7748],
    "added_mass": [1.0, 16.0, 16.0, 0.005, 1.3, 1.3],
    "linear_damping": [
        [2.4, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 23.0, 0.0, 0.0, 0.0, -11.5],
        [0.0, 0.0, 23.0, 0.0, 11.5, 0.0],
        [0.0, 0.0, 0.0, 0.3, 0.0, 0.0],
        [0.0, 0.0, -3.1, 0.0, 9.7, 0.0],
        [0.0, 3.1, 0.0, 0.0, 0.0, 9.7],
    ],
    "quadratic_damping": [
        [2.4, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, 80.0, 0.0, 0.0, 0.0, -0.3],
        [0.0, 0.0, 80.0, 0.0, 0.3, 0.0],
        [0.0, 0.0, 0.0, 0.0006, 0.0, 0.0],
        [0.0, 0.0, -1.5, 0.0, 9.1, 0.0],
        [0.0, 1.5, 0.0, 0.0, 0.0, 9.1],
    ],
}

ECA_A9 = {  # its linear_damping_forward_speed: with the surge speed, beside C_A
    "volume_m3": 1.98 * np.pi * 0.115**2,
    "mass_kg": 69.7,
    "cg_m": [0.0, 0.0, 0.0],
    "cb_m": [0.0, 0.0, -0.06],
    "inertia_kg_m2": [0.6, 30.0, 30.5],
    "added_mass": [4.0, 95.0, 75.0, 0.4, 27.0, 32.0],
    "linear_damping": [0.0] * 6,
    "quadratic_damping": [8.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    "cross_terms": {
        "added_mass_included": False,
        "Y_uv": -162.0,
        "Y_ur": 150.0,
        "N_uv": -34.0,
        "N_ur": -32.0,
        "Z_uw": -108.0,
        "Z_uq": -100.0,
        "M_uw": 37.0,
        "M_uq": -20.0,
        "K_up": -13.0,
    },
}


def hull_vehicle(hull: dict) -> Vehicle:
    """The reference vehicle's actuators and water with another hull and an arm of no account."""
    data = load_vehicle().model_dump(mode="json")
    data["hull"] = hull
    for link in data["arm"]["links"]:
        link.update(mass_kg=1e-9, volume_m3=1e-12, inertia_kg_m2=[1e-16] * 3, drag=[])
        link.update(added_mass=[0.0] * 6, cg_m=[0.0] * 3, cb_m=[0.0] * 3, cylinder=None)
    return vehicle_from_data(data)


def sway_yaw(hull: Hull, speed: float) -> np.ndarray:
    """A (2, 2) of (v, r) at a surge speed, assembled from M, C_RB, C_A and D by hand."""
    rigid = move_to_origin(
        hull.mass_kg * np.eye(3), np.array(hull.inertia_kg_m2), np.array(hull.cg_m)
    )
    inertia, ahead = rigid + np.array(hull.added_mass), speed * np.eye(6)[0]
    columns = []
    for axis in (1, 5):
        small = 1e-6 * np.eye(6)[axis]
        turning = (kirchhoff(inertia, ahead + small) - kirchhoff(inertia, ahead - small)) / 2e-6
        damping = (linear_matrix(hull) + speed * lift_matrix(hull))[:, axis]
        columns.append(-(turning + damping))
    pair = np.ix_([1, 5], [1, 5])
    return np.linalg.solve(inertia[pair], np.array(columns).T[[1, 5]])
