"""Battery and electrical power: what is given in part, and what no battery can give."""

from collections.abc import Iterator

from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.thrusters import Thruster
from uvms_core.vehicle.vehicle import Vehicle

SHORTEST_H = 0.1
"""A battery that is empty so soon with no thrust at all is one of a wrong unit, h."""


def check_energy(vehicle: Vehicle) -> Iterator[Finding]:
    """Warnings only: without these data everything else goes on."""
    if vehicle.electrical is None:
        if any(thruster.power is not None for thruster in vehicle.thrusters):
            yield Finding(
                "thrusters", "they have `power`, but there is no `electrical`; it says nothing"
            )
        return
    if lack := vehicle.lacks_power:
        yield Finding("electrical", f"{lack}; no energy can be worked out")
    yield from _battery(vehicle)


def greatest_power_w(vehicle: Vehicle) -> float:
    """Hotel load and all thrusters at whichever limit takes more, W; the arm is left out."""
    hotel = 0.0 if vehicle.electrical is None else vehicle.electrical.hotel_load_w
    density = vehicle.environment.water_density_kg_m3
    return hotel + sum(_greatest(thruster, density) for thruster in vehicle.thrusters)


def _greatest(thruster: Thruster, density: float) -> float:
    if thruster.power is None:
        return 0.0
    return float(thruster.power.power([thruster.astern_n, thruster.ahead_n], density).max())


def _battery(vehicle: Vehicle) -> Iterator[Finding]:
    battery = vehicle.battery
    if battery is None or vehicle.electrical is None:
        return
    hotel = vehicle.electrical.hotel_load_w
    if hotel * SHORTEST_H > battery.energy_wh:
        yield Finding(
            "electrical.battery",
            f"{battery.energy_wh:.4g} Wh are gone after {60.0 * battery.energy_wh / hotel:.3g}"
            f" minutes of the hotel load of {hotel:g} W alone, less than {60.0 * SHORTEST_H:g}",
        )
    empty, resistance = battery.voltages_v[1], battery.internal_resistance_ohm
    most = greatest_power_w(vehicle)
    if 4.0 * resistance * most > empty**2:
        yield Finding(
            "electrical.battery.internal_resistance_ohm",
            f"{resistance:g} ohm: nearly empty it gives {empty**2 / (4.0 * resistance):.4g} W at"
            f" most, and full thrust takes {most:.4g} W",
        )
