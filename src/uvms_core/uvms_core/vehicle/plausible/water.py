"""Gravity and water: what there is on worlds with an ocean."""

from collections.abc import Iterator

from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.vehicle import Vehicle

NONE = 1e-6
"""Below this gravity or density is left out on purpose, as in a study without weight or water."""

EARTH_GRAVITY = 9.76, 9.84
"""Least and greatest on the sea's surface, m/s^2 (9.780 at the equator, 9.832 at the poles)."""

GREATEST_GRAVITY = 25.0
"""No planet of the solar system has more at its surface (Jupiter 24.8)."""

SEA_DENSITY = 950.0, 1260.0
"""Least and greatest of natural water, kg/m^3: boiling fresh water 958, the Dead Sea 1240."""

LIQUID_DENSITY = 400.0, 2000.0
"""Least and greatest of liquids that a vehicle could float in, kg/m^3 (methane, heavy brine)."""

VISCOSITY = 1e-7, 1e-4
"""Least and greatest, m^2/s: boiling water 2.9e-7, a hundred times cold sea water."""

GREATEST_PRESSURE = 2e5
"""A pressure at the surface above this is not in Pa, or is that of a chamber."""


def check_water(vehicle: Vehicle) -> Iterator[Finding]:
    """Gravity, density, viscosity and air pressure."""
    environment = vehicle.environment
    yield from _gravity(environment.gravity_m_s2)
    yield from _density(environment.water_density_kg_m3)
    low, high = VISCOSITY
    if not low <= (value := environment.kinematic_viscosity_m2_s) <= high:
        yield Finding(
            "environment.kinematic_viscosity_m2_s",
            f"{value:g} m^2/s is outside {low:g} to {high:g}; water has 3e-7 (boiling) to 1.8e-6"
            " (freezing sea)",
        )
    if (value := environment.atmospheric_pressure_pa) > GREATEST_PRESSURE:
        yield Finding(
            "environment.atmospheric_pressure_pa",
            f"{value:g} Pa is above {GREATEST_PRESSURE:g}; the air at sea level has 101325",
        )


def _gravity(value: float) -> Iterator[Finding]:
    field, (low, high) = "environment.gravity_m_s2", EARTH_GRAVITY
    if value > GREATEST_GRAVITY:
        yield Finding(
            field,
            f"{value:g} m/s^2 is above {GREATEST_GRAVITY:g}; no planet of the solar system has"
            " more, and the Earth has 9.81",
            True,
        )
    elif value > NONE and not low <= value <= high:
        yield Finding(
            field,
            f"{value:g} m/s^2 is outside {low:g} to {high:g}, what there is at the Earth's sea",
        )


def _density(value: float) -> Iterator[Finding]:
    field, (low, high) = "environment.water_density_kg_m3", LIQUID_DENSITY
    if value > NONE and not low <= value <= high:
        yield Finding(
            field,
            f"{value:g} kg/m^3 is outside {low:g} to {high:g}; no vehicle floats in such a liquid,"
            " and sea water has 1025 (in g/cm^3 it would be 1.025)",
            True,
        )
    elif value > NONE and not SEA_DENSITY[0] <= value <= SEA_DENSITY[1]:
        yield Finding(
            field,
            f"{value:g} kg/m^3 is outside {SEA_DENSITY[0]:g} to {SEA_DENSITY[1]:g}; natural water"
            " is between boiling fresh water and the Dead Sea",
        )
