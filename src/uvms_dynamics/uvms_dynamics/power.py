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
        kinds = [thruster.power for thruster in vehicle.thrusters]
        self._per_disc = np.array([_of_one_newton(kind, self._density) for kind in kinds])
        self._tables = _tables(kinds)
        self._per_work = 1.0 / vehicle.electrical.arm_efficiency
        self.hotel: float = vehicle.electrical.hotel_load_w
        """Power that is taken all the time, W."""

    def thrusters(self, thrust: Array) -> Array:
        """Power (k, m) W of thrusts (k, m) N."""
        size = np.abs(thrust)
        power: Array = size * np.sqrt(size) * self._per_disc
        for kind, columns in self._tables:
            power[:, columns] = kind.power(thrust[:, columns], self._density)
        return power

    def arm(self, effort: Array, q_dot: Array) -> Array:
        """Power (k,) W of the joints' drives.

        effort (k, n) or (n,) are their torques, N m; q_dot (k, n) the rates, rad/s.
        """
        return self._per_work * np.maximum(effort * q_dot, 0.0).sum(axis=1)


def _of_one_newton(kind: ThrusterPower | None, density: float) -> float:
    """That of an actuator disc, W, from which all others follow; 0 for a table."""
    return float(kind.power(1.0, density)) if kind is not None and kind.is_disc else 0.0


Columns = slice | NDArray[np.intp]


def _tables(kinds: list[ThrusterPower | None]) -> list[tuple[ThrusterPower, Columns]]:
    """Each table once, with the columns of the thrusters that have it."""
    found: dict[ThrusterPower, list[int]] = {}
    for column, kind in enumerate(kinds):
        if kind is not None and not kind.is_disc:
            found.setdefault(kind, []).append(column)
    return [
        (kind, slice(None) if len(columns) == len(kinds) else np.array(columns))
        for kind, columns in found.items()
    ]
