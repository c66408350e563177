"""Random vehicles that are physically possible, and random motions of them."""

from typing import NamedTuple

import numpy as np

from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data

REFERENCE = load_vehicle()


class Motion(NamedTuple):
    quat: np.ndarray
    nu: np.ndarray
    nu_dot: np.ndarray
    q: np.ndarray
    q_dot: np.ndarray
    q_ddot: np.ndarray


def random_motion(rng: np.random.Generator, n: int) -> Motion:
    quat = rng.normal(size=4)
    vectors = [rng.normal(size=6), rng.normal(size=6), *rng.uniform(-2.0, 2.0, (3, n))]
    return Motion(quat / np.linalg.norm(quat), *vectors)


def norm_error(found: np.ndarray, expected: np.ndarray) -> float:
    """|found - expected| / |expected|, in the 2-norm over all components."""
    return float(np.linalg.norm(found - expected) / np.linalg.norm(expected))


def random_vehicle(seed: int, n: int, **changes) -> Vehicle:
    """A vehicle of n joints whose every body has a full added mass; `changes` as in `changed`."""
    rng = np.random.default_rng(seed)
    data = REFERENCE.model_dump(mode="json")
    data["hull"].update(_body(rng, mass=50.0), spheroid=None)
    data["hull"]["linear_damping"] = rng.uniform(0.0, 50.0, 6).tolist()
    data["hull"]["quadratic_damping"] = rng.uniform(0.0, 100.0, 6).tolist()
    data["hull"].update(fins=[], cross_terms=None)
    joint, link = data["arm"]["joints"][0], data["arm"]["links"][0]
    data["arm"].update(
        base=_mounting(rng),
        tool=_mounting(rng),
        stowed_deg=[0.0] * n,
        postures_deg={},
        joints=[{**joint, **_joint(rng), "name": f"j{i}"} for i in range(n)],
        links=[{**link, **_link(rng), "name": f"l{i}"} for i in range(n)],
    )
    if seed % 2:
        data["hull"].update(_resistance(np.random.default_rng(seed)))
    return changed(vehicle_from_data(data), **changes)


def _resistance(rng: np.random.Generator) -> dict:
    """Full damping that takes energy, products with the surge speed, and fins anywhere."""
    root, skew = rng.normal(size=(6, 6)), rng.normal(size=(6, 6))
    quadratic = rng.normal(size=(6, 6))
    # |nu_i| |nu_j|^2 <= (|nu_i|^3 + 2 |nu_j|^3) / 3, so that much on the diagonal is enough.
    size = np.abs(quadratic - np.diag(np.diag(quadratic)))
    np.fill_diagonal(quadratic, (size.sum(axis=1) + 2.0 * size.sum(axis=0)) / 3.0)
    lift = {"added_mass_included": False, "Y_uv": -30.0, "Y_ur": 6.0, "N_uv": 10.0, "N_ur": -4.0}
    lift |= {"Z_uw": -28.0, "Z_uq": -6.0, "M_uw": -11.0, "M_uq": -4.0, "K_up": -0.5}
    return {
        "linear_damping": (10.0 * (root @ root.T + skew - skew.T + 3.0 * np.eye(6))).tolist(),
        "quadratic_damping": (10.0 * quadratic).tolist(),
        "cross_terms": lift,
        "speeds_m_s": [0.0, 0.5],
        "fins": [_fin(rng, f"fin {k}") for k in range(rng.integers(1, 4))],
    }


def _fin(rng: np.random.Generator, name: str) -> dict:
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    return {
        "name": name,
        "position_m": rng.normal(size=3).tolist(),
        "normal": axes[0].tolist(),
        "chord": axes[1].tolist(),
        "area_m2": rng.uniform(0.01, 0.1),
        "aspect_ratio": rng.uniform(0.5, 6.0),
        "incidence_deg": rng.uniform(-20.0, 20.0),
        "stall_deg": rng.uniform(10.0, 40.0),
    }


def changed(
    vehicle: Vehicle,
    water: bool = True,
    drag: bool = True,
    gravity: bool = True,
    neutral: bool = False,
) -> Vehicle:
    """The vehicle without water, all that dissipates, or gravity; or with neutral bodies."""
    data = vehicle.model_dump(mode="json")
    bodies = [data["hull"], *data["arm"]["links"]]
    if not gravity:
        data["environment"]["gravity_m_s2"] = 1e-30
    if neutral:
        for body in bodies:
            body["volume_m3"] = body["mass_kg"] / data["environment"]["water_density_kg_m3"]
    if not water:
        data["environment"]["water_density_kg_m3"] = 1e-30
        for body in bodies:
            body["added_mass"] = [0.0] * 6
    if not (water and drag):
        _remove_drag(data)
    return vehicle_from_data(data)


def _remove_drag(data: dict) -> None:
    """And all friction and stops."""
    data["hull"].update(linear_damping=[0.0] * 6, quadratic_damping=[0.0] * 6)
    data["hull"].update(fins=[], cross_terms=None)
    for link in data["arm"]["links"]:
        link["drag"] = []
    for joint in data["arm"]["joints"]:
        joint.update(viscous_friction_nm_s=0.0, coulomb_friction_nm=0.0, stop_stiffness_nm_rad=0.0)


def _mounting(rng: np.random.Generator) -> dict:
    return {
        "position_m": rng.normal(size=3).tolist(),
        "rpy_deg": rng.uniform(-180.0, 180.0, 3).tolist(),
    }


def _joint(rng: np.random.Generator) -> dict:
    return {
        "a_m": rng.normal(scale=0.4),
        "alpha_deg": rng.uniform(-180.0, 180.0),
        "d_m": rng.normal(scale=0.4),
        "offset_deg": rng.uniform(-180.0, 180.0),
        "rotor_inertia_kg_m2": rng.uniform(0.01, 0.2),
    }


def _body(rng: np.random.Generator, mass: float) -> dict:
    """Mass and inertia of six point masses, a full added mass, and centres that differ."""
    points, masses = rng.normal(scale=0.3, size=(6, 3)), rng.uniform(0.1, 1.0, 6)
    masses *= mass / masses.sum()
    cg = masses @ points / mass
    r = points - cg
    inertia = sum(m * (x @ x * np.eye(3) - np.outer(x, x)) for m, x in zip(masses, r, strict=True))
    root = rng.normal(size=(6, 6))
    return {
        "mass_kg": mass,
        "volume_m3": mass / 1025.0 * rng.uniform(0.5, 1.5),
        "cg_m": cg.tolist(),
        "cb_m": rng.normal(scale=0.2, size=3).tolist(),
        "inertia_kg_m2": inertia.tolist(),
        "added_mass": (mass * root @ root.T / 12.0).tolist(),
    }


def _link(rng: np.random.Generator) -> dict:
    axes = rng.normal(size=(2, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    drag = [
        {
            "center_m": rng.normal(scale=0.3, size=3).tolist(),
            "axis": axis.tolist(),
            "radius_m": rng.uniform(0.02, 0.1),
            "length_m": rng.uniform(0.1, 0.6),
            "stations": int(rng.integers(1, 6)),
        }
        for axis in axes
    ]
    return {**_body(rng, mass=rng.uniform(1.0, 5.0)), "drag": drag, "cylinder": None}
