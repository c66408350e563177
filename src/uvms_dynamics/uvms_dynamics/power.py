"""Electrical power that a motion takes: thrusters by their thrust, joints by their work, the rest.

    P = sum_i P_i(T_i) + sum_j max(tau_j q_dot_j, 0) / eta + P_hotel

A thruster takes what it takes at rest for the thrust that it gives, whatever the flow into it. A
drive that brakes a joint gives nothing back; what it takes to hold one at rest is not counted.
"""

import numpy as np
from numpy.typing import NDArray

from uvms_core.errors import ConfigError
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.thruster_power import ThrusterPower


class PowerDraw:
    """Electrical power of one vehicle.

    Raises:
        ConfigError: the vehicle file does not say what is taken, `Vehicle.lacks_power`.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        if vehicle.electrical is None or vehicle.lacks_power:
            raise ConfigError(vehicle.lacks_power)
        self._density = vehicle.environment.water_density_kg_m3
        self._groups = _groups([thruster.power for thruster in vehicle.thrusters])
        self._per_work = 1.0 / vehicle.electrical.arm_efficiency
        self.hotel: float = vehicle.electrical.hotel_load_w
        """Power that is taken all the time, W."""

    def thrusters(self, thrust: Array) -> Array:
        """Power (k, m) W of thrusts (k, m) N."""
        power = np.empty_like(thrust)
        for kind, columns in self._groups:
            power[:, columns] = kind.power(thrust[:, columns], self._density)
        return power

    def arm(self, effort: Array, q_dot: Array) -> Array:
        """Power (k,) W of the joints' drives.

        effort (k, n) or (n,) are their torques, N m; q_dot (k, n) the rates, rad/s.
        """
        return self._per_work * np.maximum(effort * q_dot, 0.0).sum(axis=1)


Columns = slice | NDArray[np.intp]


def _groups(kinds: list[ThrusterPower | None]) -> list[tuple[ThrusterPower, Columns]]:
    """Each kind of thruster once, with the columns of those that are of it."""
    found: dict[ThrusterPower, list[int]] = {}
    for column, kind in enumerate(kinds):
        if kind is not None:
            found.setdefault(kind, []).append(column)
    if len(found) == 1:
        return [(next(iter(found)), slice(None))]
    return [(kind, np.array(columns)) for kind, columns in found.items()]
