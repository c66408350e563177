"""The electrical supply of the plant: what its motion takes, and what its battery has left."""

from collections.abc import Iterator

import numpy as np

from uvms_core.battery import battery_status
from uvms_core.diagnostics import OK
from uvms_core.signals import Array, BatteryState, to_nanoseconds, to_seconds
from uvms_core.topics import BATTERY_PERIOD_S
from uvms_core.vehicle import Vehicle
from uvms_dynamics.power import PowerDraw
from uvms_dynamics.simulation.battery import BatteryPack, Energy
from uvms_dynamics.simulation.integrator import JOINTS


class Supply:
    """Integrates the power that a vehicle takes; does nothing where the file does not give it.

    Args:
        vehicle: as the plant has it.
        share: of the battery's charge at the start, 0 to 1.
        step: of the integrator, ns.
    """

    def __init__(self, vehicle: Vehicle, share: float, step: int) -> None:
        self._draw = None if vehicle.lacks_power else PowerDraw(vehicle)
        self._pack = None
        if self._draw is not None and vehicle.battery is not None:
            self._pack = BatteryPack(vehicle.battery, share, self._draw.hotel)
        self._n, self._step_s = vehicle.n_joints, to_seconds(step)
        self._period = to_nanoseconds(BATTERY_PERIOD_S)
        self._thrusters, self._arm, self._hotel = np.zeros(vehicle.n_thrusters), 0.0, 0.0
        self._weights = np.empty(0)  # of the trapezoidal rule, s
        self._last_due = -1
        self._told = OK

    @property
    def energy(self) -> Energy | None:
        """What was taken since the start; None where it is not known what is taken."""
        if self._draw is None:
            return None
        return Energy(self._thrusters.copy(), self._arm, self._hotel)

    @property
    def share(self) -> float | None:
        """Share of the battery's charge that is left, 0 to 1; None where there is none."""
        return None if self._pack is None else self._pack.share

    @property
    def is_empty(self) -> bool:
        """Whether there is a battery that has nothing left."""
        return self._pack is not None and self._pack.is_empty

    def take(self, states: Array, effort: Array) -> None:
        """Give what the steps from the first to the last row of states (k+1, nx) take.

        effort (n,) N m are the torques of the drives meanwhile; trapezoidal rule.
        """
        if self._draw is None or self.is_empty:
            return
        first, steps = JOINTS + self._n, len(states) - 1
        if len(self._weights) != len(states):
            self._weights = self._step_s * np.array([0.5, *[1.0] * (steps - 1), 0.5])
        seconds = self._step_s * steps
        rates, thrust = states[:, first : first + self._n], states[:, first + self._n :]
        thrusters = self._weights @ self._draw.thrusters(thrust)
        arm = float(self._weights @ self._draw.arm(effort, rates))
        hotel = self._draw.hotel * seconds
        self._thrusters += thrusters
        self._arm, self._hotel = self._arm + arm, self._hotel + hotel
        if self._pack is not None:
            self._pack.take((float(thrusters.sum()) + arm + hotel) / seconds, seconds)

    def sample(self, stamp: int) -> BatteryState | None:
        """The battery's state at a control tick, ns, where one is due; None in between."""
        due = stamp // self._period
        if self._pack is None or due == self._last_due:
            return None
        self._last_due = due
        return self._pack.sample(stamp)

    def news(self) -> Iterator[str]:
        """What has become of the battery since this was last asked, in words: low, or empty."""
        level, text = battery_status(self.share)
        if level > self._told:
            self._told = level
            yield text
