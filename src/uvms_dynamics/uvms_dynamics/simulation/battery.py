"""The vehicle's battery: charge that is left, voltage, and energy that was taken, by consumer.

With the open-circuit voltage U, linear in the charge, and the resistance R a power P takes the
current I of P = (U - I R) I, the smaller root: I = 2 P / (U + sqrt(U^2 - 4 R P)). More than
U^2 / 4R is not to be had: there the current stays at U / 2R.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np

from uvms_core.signals import Array, BatteryState
from uvms_core.vehicle.electrical import Battery

SECONDS_AN_HOUR = 3600.0


@dataclass(frozen=True)
class Energy:
    """Electrical energy that was taken since the start, J."""

    thrusters: Array  # (m,)
    arm: float
    hotel: float

    @property
    def total(self) -> float:
        """All of it, J."""
        return float(self.thrusters.sum()) + self.arm + self.hotel


class BatteryPack:
    """A battery that is discharged.

    Args:
        battery: of the vehicle file.
        share: of its charge that it has at the start, 0 to 1.
        idle: power that is taken before the first sample, W.
    """

    def __init__(self, battery: Battery, share: float, idle: float) -> None:
        self._full, self._empty = battery.voltages_v
        self._resistance = battery.internal_resistance_ohm
        self._capacity = battery.charge_ah * SECONDS_AN_HOUR  # A s
        self._charge = share * self._capacity
        self._idle = idle
        self._noted, self._noted_at = self._charge, 0  # at the last sample

    @property
    def share(self) -> float:
        """Share of its charge that is left, 0 to 1."""
        return self._charge / self._capacity

    @property
    def is_empty(self) -> bool:
        """Whether nothing is left."""
        return self._charge <= 0.0

    def current(self, power: float) -> float:
        """Current, A, positive, at which it gives a power, W, or the most that it has."""
        voltage = self._open_voltage()
        root = sqrt(max(voltage**2 - 4.0 * self._resistance * power, 0.0))
        if root == 0.0:
            return voltage / (2.0 * self._resistance)
        return 2.0 * power / (voltage + root)

    def take(self, power: float, seconds: float) -> None:
        """Give a constant power, W, for a while, s; it has no less than nothing then."""
        self._charge = max(self._charge - self.current(power) * seconds, 0.0)

    def sample(self, stamp: int) -> BatteryState:
        """Its state at a stamp, ns; values are those of 32-bit numbers, as its message has them."""
        elapsed = (stamp - self._noted_at) / 1e9
        mean = (self._noted - self._charge) / elapsed if elapsed > 0.0 else self._at_first()
        self._noted, self._noted_at = self._charge, stamp
        voltage = self._open_voltage() - mean * self._resistance
        ampere_hours = (self._charge / SECONDS_AN_HOUR, self._capacity / SECONDS_AN_HOUR)
        return BatteryState(stamp, *map(_single, (voltage, -mean, *ampere_hours, self.share)))

    def _at_first(self) -> float:
        return 0.0 if self.is_empty else self.current(self._idle)

    def _open_voltage(self) -> float:
        return self._empty + (self._full - self._empty) * self.share


def _single(value: float) -> float:
    return float(np.float32(value))
