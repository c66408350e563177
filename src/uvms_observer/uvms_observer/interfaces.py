"""What a disturbance observer and a navigation filter must do to take part in the loop.

Any class with these methods will do; it need not derive from the protocol. Its constructor is
called with the vehicle (`uvms_core.vehicle.Vehicle`) and its section of the configuration
(`ObserverConfig`, `NavigationConfig`), in that order.
"""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

from uvms_core.errors import SignalError
from uvms_core.signals import (
    DisturbanceBudget,
    JointStates,
    Odometry,
    Wrench,
)


class ObserverLaw(Protocol):
    """Estimates the wrench that acts on the vehicle besides its thrusters.

    An observer that wants the thrusts one by one has a method `inform(allocation)`, which is called
    before each step with the `Allocation` of the tick before (None at the first). A method
    `prepare(period)`, in s, is called once before the first step.
    """

    @abstractmethod
    def step(
        self, odometry: Odometry, joints: JointStates, achieved: Wrench | None
    ) -> tuple[DisturbanceBudget, Wrench]:
        """The disturbance at `odometry.stamp`, part by part and as it is fed forward.

        Args:
            odometry: estimated pose in map_ned and velocity in the body frame.
            joints: angles and rates of the joints at the same stamp.
            achieved: wrench of the thrusts commanded at the stamp before, N and N m; None if it is
                not known.

        Returns:
            The parts, and the total that the controller takes off its wrench: what acts ON the
            vehicle, body frame, about its origin, N and N m.
        """
        ...


class NavigationEstimator(Protocol):
    """Estimates the vehicle's motion from the samples of its sensors.

    A method `resume(estimate: Odometry)`, where there is one, is called before the first step of a
    filter that begins in the middle of a run: it begins there, as uncertain as the estimate says.
    A method `waits_for() -> str`, where there is one, says after each step what it still waits for;
    until it returns an empty text nothing is published. A filter that wants the thrusts has a
    method `inform(allocation)`, which is called before each step with the `Allocation` of the tick
    before (None where there is none).
    """

    @abstractmethod
    def step_screened(
        self, stamp: int, samples: Mapping[str, Sequence[Any]]
    ) -> tuple[Odometry, list[SignalError]]:
        """The estimate at `stamp` (ns) from the samples since the last step, by sensor.

        Returns:
            The estimate, and an error for each sample that is left out.
        """
        ...

    @abstractmethod
    def status(self) -> Mapping[str, int | float | str]:
        """Counters and other numbers for /diagnostics."""
        ...
