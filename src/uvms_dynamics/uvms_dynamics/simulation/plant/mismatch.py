"""How far the plant may be from the model: uniform draws by the seed of the run.

Each field has random numbers of its own, so that one that is added does not change the others'
draws. Whatever is drawn, bodies stay possible: masses and inertias are scaled alike, which keeps
the triangle inequality, added mass by a congruence S A S, which keeps it positive, and damping that
couples axes as a whole, which keeps it dissipative. The lift of cross terms is no part of the added
mass: it stays where that is drawn, also where the file gives both in one coefficient.
"""

from typing import Any

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.rng import generator
from uvms_core.signals import Array
from uvms_core.vehicle import Hull, Link, Vehicle
from uvms_core.vehicle.damping import PRODUCTS, CrossTerms, is_coupled, lift_alone
from uvms_core.vehicle.fins import Fin
from uvms_core.vehicle.plausible.water import NONE

MOST = 0.5
"""Greatest relative half width: half or one and a half times as much is another vehicle."""

Draws = dict[str, Any]
"""What was drawn by field: numbers, and lists of numbers."""


def _share(what: str) -> Any:
    return Field(0.0, ge=0.0, le=MOST, description=f"{what}; 0.2 is 20 %")


class Mismatch(Config):
    """Half widths of the uniform draws by which the plant differs from the vehicle file."""

    mass: float = _share(
        "mass and inertia of the hull, as by more or less water inside: weight in water and"
        " righting moment do not change"
    )
    added_mass: float = _share("added mass of the hull, each axis by itself")
    damping: float = _share(
        "linear and quadratic damping of the hull and the area of its fins, each axis by itself;"
        " one factor for them and cross_terms where a table or cross_terms couple the axes"
    )
    link_mass: float = _share("mass and inertia of each link; its volume stays")
    link_added_mass: float = _share("added mass of each link")
    link_drag: float = _share("drag and friction coefficient of the links")
    thrust: float = _share("thrust of each thruster under the same command")
    buoyancy_centre_m: float = Field(
        0.0, ge=0.0, le=1.0, description="centre of buoyancy of the hull along each axis, m"
    )
    gravity_centre_m: float = Field(
        0.0, ge=0.0, le=1.0, description="centre of gravity of the hull along each axis, m"
    )
    weight_n: float = Field(
        0.0, ge=0.0, le=1e5, description="weight of the hull, at its centre of gravity, N"
    )

    def draw(self, vehicle: Vehicle, seed: int) -> Draws:
        """A draw of each field that is not zero: numbers within its half width."""
        links, thrusters = vehicle.n_joints, vehicle.n_thrusters
        counts = {
            "mass": 1,
            "added_mass": 6,
            "damping": 1 if is_coupled(vehicle.hull) else 12,
            "link_mass": links,
            "link_added_mass": links,
            "link_drag": 2,
            "thrust": thrusters,
            "buoyancy_centre_m": 3,
            "gravity_centre_m": 3,
            "weight_n": 1,
        }
        return {name: _uniform(seed, name, half, counts[name]) for name, half in self if half > 0.0}


def _uniform(seed: int, name: str, half: float, count: int) -> float | list[float]:
    values = half * generator(seed, f"plant/mismatch/{name}").uniform(-1.0, 1.0, count)
    return float(values[0]) if count == 1 else values.tolist()


def mismatched(vehicle: Vehicle, draws: Draws) -> dict[str, Any]:
    """Plain data of the vehicle with these draws; thrust is not among it."""
    hull = _hull(vehicle.hull, draws, vehicle)
    links = tuple(_link(link, i, draws) for i, link in enumerate(vehicle.arm.links))
    arm = vehicle.arm.model_copy(update={"links": links})
    data: dict[str, Any] = vehicle.model_copy(update={"hull": hull, "arm": arm}).model_dump(
        warnings=False
    )
    cross, along = _pair(draws.get("link_drag"))
    _scale_coefficient(data["arm"]["drag_coefficient"], cross)
    _scale_coefficient(data["arm"]["friction_coefficient"], along)
    return data


def _hull(hull: Hull, draws: Draws, vehicle: Vehicle) -> Hull:
    changes: dict[str, Any] = {}
    if "mass" in draws:
        changes |= _more_water(hull, draws["mass"], vehicle.environment.water_density_kg_m3)
    if "added_mass" in draws:
        changes["added_mass"] = _congruent(hull.added_mass, draws["added_mass"])
        changes["cross_terms"] = lift_alone(hull)
    hull = hull.model_copy(update=changes)
    if "damping" in draws:
        hull = hull.model_copy(update=_damped(hull, draws["damping"]))
    if "weight_n" in draws:
        hull = hull.model_copy(update=_heavier(hull, draws["weight_n"], vehicle))
    shifts = {"cb_m": "buoyancy_centre_m", "cg_m": "gravity_centre_m"}
    moved = {
        name: tuple(np.add(getattr(hull, name), draws[field]).tolist())
        for name, field in shifts.items()
        if field in draws
    }
    return hull.model_copy(update=moved)


def _damped(hull: Hull, draw: float | list[float]) -> dict[str, Any]:
    """Changes by draws for the 6 linear and 6 quadratic values, or by one for all of them."""
    draws = draw if isinstance(draw, list) else [draw] * 12
    linear, quadratic = draws[:6], draws[6:]
    return {
        "linear_damping": _scaled(hull.linear_damping, linear),
        "quadratic_damping": _scaled(hull.quadratic_damping, quadratic),
        "fins": tuple(_larger(fin, quadratic) for fin in hull.fins),
        "cross_terms": _times(lift_alone(hull), 1.0 + draws[0]),
    }


def _times(terms: CrossTerms | None, factor: float) -> CrossTerms | None:
    """Products, without those of the added mass, times a factor."""
    if terms is None:
        return None
    given = {name: getattr(terms, name) for name in PRODUCTS}
    changes = {name: factor * value for name, value in given.items() if value is not None}
    return terms.model_copy(update=changes)


def _larger(fin: Fin, draws: list[float]) -> Fin:
    """A fin whose area changes as the damping of the axis that it acts along."""
    share = float(np.square(fin.normal) @ draws[:3])
    return fin.model_copy(update={"area_m2": (1.0 + share) * fin.area_m2})


def _more_water(hull: Hull, share: float, density: float) -> dict[str, Any]:
    """Changes by water inside the hull, at its centre of gravity, that moves with it.

    It weighs nothing in water: volume and centre of buoyancy change such that weight less buoyancy
    and its moment stay.
    """
    changes = {
        "mass_kg": hull.mass_kg * (1.0 + share),
        "inertia_kg_m2": ((1.0 + share) * np.array(hull.inertia_kg_m2)).tolist(),
    }
    if density <= NONE:
        return changes
    water = share * hull.mass_kg / density
    volume = hull.volume_m3 + water
    centre = (hull.volume_m3 * np.array(hull.cb_m) + water * np.array(hull.cg_m)) / volume
    return changes | {"volume_m3": volume, "cb_m": tuple(centre.tolist())}


def _heavier(hull: Hull, weight: float, vehicle: Vehicle) -> dict[str, Any]:
    gravity = vehicle.environment.gravity_m_s2
    factor = 1.0 + (weight / (gravity * hull.mass_kg) if gravity > NONE else 0.0)
    return {
        "mass_kg": factor * hull.mass_kg,
        "inertia_kg_m2": (factor * np.array(hull.inertia_kg_m2)).tolist(),
    }


def _link(link: Link, i: int, draws: Draws) -> Link:
    changes: dict[str, Any] = {}
    if "link_mass" in draws:
        factor = 1.0 + _each(draws["link_mass"])[i]
        changes["mass_kg"] = factor * link.mass_kg
        changes["inertia_kg_m2"] = (factor * np.array(link.inertia_kg_m2)).tolist()
    if "link_added_mass" in draws:
        factor = 1.0 + _each(draws["link_added_mass"])[i]
        changes["added_mass"] = (factor * np.array(link.added_mass)).tolist()
    return link.model_copy(update=changes)


def _each(draw: float | list[float]) -> list[float]:
    """The draws of several parts; of one alone it is a number."""
    return draw if isinstance(draw, list) else [draw]


def _pair(draw: list[float] | None) -> tuple[float, float]:
    return (0.0, 0.0) if draw is None else (draw[0], draw[1])


def _congruent(table: Any, draws: list[float]) -> list[list[float]]:
    """S A S with S = diag(sqrt(1 + d)): entry (i, i) is 1 + d_i times as great."""
    roots = np.sqrt(1.0 + np.array(draws))
    return (roots[:, None] * np.array(table) * roots).tolist()


def _scaled(damping: Any, draws: list[float]) -> Any:
    """Damping, each row by its factor; those of a table are alike."""
    values: Array = np.array(damping)
    return ((1.0 + np.array(draws)) * values.T).T.tolist()


def _scale_coefficient(coefficient: dict[str, Any], share: float) -> None:
    if share:
        coefficient["cd"] = tuple((1.0 + share) * value for value in coefficient["cd"])
