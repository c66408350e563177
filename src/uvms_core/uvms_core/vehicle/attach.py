"""Hull and attachments as one rigid body: after loading, nothing else has to handle them."""

import numpy as np

from uvms_core.vehicle.environment import Environment
from uvms_core.vehicle.hull import Hull


def with_attachments(hull: Hull, environment: Environment) -> Hull:
    """The hull with its attachments counted in mass, volume, centers and inertia, and then removed.

    An attachment of mass m and wet weight W displaces V = (m - W / g) / rho and is a point: it adds
    m and m d^2 to the inertia, and no added mass. One without a mass of its own changes weight,
    buoyancy and their moments by W alone (V = -W / (rho g), below zero for a sinker).
    """
    extras = hull.attachments
    if not extras:
        return hull
    g, density = environment.gravity_m_s2, environment.water_density_kg_m3
    places = np.array([hull.cg_m, *(extra.position_m for extra in extras)])
    masses = np.array([hull.mass_kg, *(extra.mass_kg for extra in extras)])
    wet = np.array([extra.wet_weight_n for extra in extras])
    volumes = np.array([hull.volume_m3, *((masses[1:] - wet / g) / density)])
    cg = masses @ places / masses.sum()
    inertia = np.array(hull.inertia_kg_m2)
    for mass, lever in zip(masses, places - cg, strict=True):
        inertia += mass * (lever @ lever * np.eye(3) - np.outer(lever, lever))
    places[0] = hull.cb_m
    changes = {
        "mass_kg": float(masses.sum()),
        "volume_m3": float(volumes.sum()),
        "cg_m": tuple(cg.tolist()),
        "cb_m": tuple((volumes @ places / volumes.sum()).tolist()),
        "inertia_kg_m2": inertia.tolist(),
        "attachments": (),
    }
    return hull.model_copy(update=changes)
