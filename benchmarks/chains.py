"""Random vehicles with arms of any number of joints, for metrics over the number of joints.

Each is a torpedo with a slender arm: links of cylinders along their common normals, general angles
between the joints (no parallel axes, so that no term vanishes), a full 6x6 added mass on
every body, strips of drag on every link, damping, buoyancy, friction, rotors. The reach is about
1.6 m, or 0.12 m a joint where that is more, as in a snake robot.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data
from uvms_core.vehicle.arm import Cylinder
from uvms_core.vehicle.shapes import cylinder_added_mass, cylinder_inertia, cylinder_volume

JOINTS = (4, 8, 16, 32)
"""Numbers of joints in the speed table."""

SEED = 1
_STILL = {"linear_damping": [0.0] * 6, "quadratic_damping": [0.0] * 6}


def chain(n: int, seed: int = SEED) -> Vehicle:
    """A vehicle with an arm of n joints; the same for the same n and seed."""
    rng = np.random.default_rng([seed, n])
    data = load_vehicle().model_dump(mode="json")
    density = data["environment"]["water_density_kg_m3"]
    joint, arm = data["arm"]["joints"][0], data["arm"]
    lengths = max(1.6 / n, 0.12) * rng.uniform(0.8, 1.2, n)
    data["hull"]["added_mass"] = _coupled(rng, np.array(data["hull"]["added_mass"]))
    data["hull"]["fins"] = []  # arms are measured, with a hull of six damping values
    data["hull"]["cg_m"] = [*rng.uniform(-0.01, 0.01, 2).tolist(), 0.012]
    arm["base"]["rpy_deg"] = rng.uniform(-180.0, 180.0, 3).tolist()
    arm["tool"]["position_m"] = [0.1, 0.0, 0.0]
    arm["stowed_deg"], arm["postures_deg"] = [0.0] * n, {}
    arm["joints"] = [{**joint, **_joint(rng, x), "name": f"joint_{i}"} for i, x in _named(lengths)]
    arm["links"] = [{**_link(rng, x, density), "name": f"link_{i}"} for i, x in _named(lengths)]
    return vehicle_from_data(data, f"chain of {n} joints")


def without_water(vehicle: Vehicle) -> Vehicle:
    """The same rigid bodies without added mass, buoyancy, damping and strips."""
    data = vehicle.model_dump(mode="json")
    data["environment"]["water_density_kg_m3"] = 1e-30
    data["hull"].update(_STILL, added_mass=[0.0] * 6)
    for link in data["arm"]["links"]:
        link.update(drag=[], added_mass=[0.0] * 6)
    return vehicle_from_data(data, f"{vehicle.name} without water")


def _named(lengths: Array):
    return enumerate(lengths.tolist(), start=1)


def _joint(rng: np.random.Generator, length: float) -> dict:
    return {
        "a_m": length,
        "alpha_deg": float(rng.uniform(-90.0, 90.0)),
        "d_m": float(rng.uniform(0.0, 0.02)),
        "offset_deg": float(rng.uniform(-30.0, 30.0)),
        "lower_deg": -170.0,
        "upper_deg": 170.0,
    }


def _link(rng: np.random.Generator, length: float, density: float) -> dict:
    """A cylinder from joint to joint, whose mass lies slightly off its axis."""
    shape = Cylinder(
        center_m=(-0.5 * length, 0.0, 0.0),
        axis=(1.0, 0.0, 0.0),
        radius_m=float(rng.uniform(0.035, 0.055)),
        length_m=length,
    )
    mass = density * cylinder_volume(shape) * float(rng.uniform(1.0, 1.3))
    turn = np.linalg.qr(np.eye(3) + rng.normal(scale=0.2, size=(3, 3)))[0]
    added = cylinder_added_mass(shape, density, shape.axial_added_mass_fraction * mass)
    return {
        "mass_kg": mass,
        "volume_m3": cylinder_volume(shape),
        "cg_m": (np.array(shape.center_m) + rng.uniform(-0.01, 0.01, 3)).tolist(),
        "cb_m": list(shape.center_m),
        "inertia_kg_m2": (turn @ cylinder_inertia(shape, mass) @ turn.T).tolist(),
        "added_mass": _coupled(rng, added),
        "drag": [shape.model_dump(exclude={"axial_added_mass_fraction"})],
        "cylinder": None,
    }


def _coupled(rng: np.random.Generator, added: Array) -> list:
    """A full, positive definite added mass near the one given: H^T M H with H near unity."""
    added = added + np.diag([0.0] * 3 + [0.01 * np.trace(added[3:, 3:])] * 3)  # about an axis, too
    near = np.eye(6) + rng.normal(scale=0.05, size=(6, 6))
    matrix = near.T @ added @ near
    return (0.5 * (matrix + matrix.T)).tolist()
