"""Inputs that several benchmarks share: the reference vehicle without water, and random motions."""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, load_vehicle

COUNT = 32


class Motion(NamedTuple):
    """One instant of vehicle and arm."""

    quat: Array
    nu: Array
    nu_dot: Array
    q: Array
    q_dot: Array
    q_ddot: Array
    tau: Array


def dry_vehicle() -> Vehicle:
    """The reference vehicle as rigid bodies in a vacuum, as a rigid-body library models it."""
    n = len(load_vehicle().arm.links)
    hull: dict = {"linear_damping": [0.0] * 6, "quadratic_damping": [0.0] * 6, "fins": []}
    changes = {f"hull.{name}": value for name, value in hull.items()}
    changes |= {"hull.added_mass": [0.0] * 6, "environment.water_density_kg_m3": 1e-30}
    for i in range(n):
        changes |= {f"arm.links.{i}.drag": [], f"arm.links.{i}.added_mass": [0.0] * 6}
    derived = load_vehicle()
    for name in ("mass_kg", "cg_m", "inertia_kg_m2"):
        changes[f"hull.{name}"] = getattr(derived.hull, name)
        for i, link in enumerate(derived.arm.links):
            changes[f"arm.links.{i}.{name}"] = getattr(link, name)
    return load_vehicle(overrides=changes)


def motions(n: int, count: int = COUNT, seed: int = 1) -> list[Motion]:
    """Random motions of a vehicle with n joints."""
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        quat = rng.normal(size=4)
        nu, nu_dot = rng.normal(size=(2, 6))
        joints = rng.uniform(-1.5, 1.5, (3, n))
        tau = rng.normal(scale=20.0, size=6 + n)
        made.append(Motion(quat / np.linalg.norm(quat), nu, nu_dot, *joints, tau))
    return made


def slow_motion(n: int, seed: int = 1) -> Motion:
    """A slow motion near level, from which a simulation of any arm stays slow."""
    rng = np.random.default_rng(seed)
    quat = np.concatenate([rng.normal(scale=0.05, size=3), [1.0]])
    nu, nu_dot = 0.1 * rng.normal(size=(2, 6))
    joints = rng.uniform(-1.0, 1.0, (3, n)) * np.array([[0.5], [0.1], [0.1]])
    tau = rng.uniform(-0.2, 0.2, 6 + n)
    return Motion(quat / np.linalg.norm(quat), nu, nu_dot, *joints, tau)
