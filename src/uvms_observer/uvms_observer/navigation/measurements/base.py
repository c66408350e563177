"""What the navigation filter asks of a measurement."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState


class Linear(NamedTuple):
    """A sample of m values about the estimate."""

    residual: Array  # (m,) measured minus expected
    H: Array  # (m, SIZE) derivative of the measurement by the error state
    N: Array  # (m, m) covariance of its noise


class Measurement(ABC):
    """How the filter uses one sensor; found by the sensor's name in `uvms.measurements`.

    A subclass gives `size`, and extends `__init__` with what it takes from the vehicle file. It
    keeps no state: the filter goes back in time for samples that come late.

    Args:
        vehicle: whose sensor it is.
        section: the sensor's own section of the vehicle file.
        config: of the filter; its floors on the noise.
    """

    size: ClassVar[int]
    """Dimension of the measurement."""
    needs_rate: ClassVar[bool] = False
    """Whether `correct` uses the rate; it is not asked while the rate is not known."""
    follows: ClassVar[bool] = False
    """Whether a sensor that has jumped away mostly goes on as before, off by something that lasts:
    then its changes are used (`trust/lasting.py`), and it has `about`. Of three values."""

    def __init__(self, vehicle: Vehicle, section: Any, config: NavigationConfig) -> None:
        imu = vehicle.sensors.imu
        self.lever: Array = np.subtract(section.position_m, imu.position_m)
        """Sensor from the IMU, (3,) m, body axes."""
        self.initial_variance: Mapping[int, float] = {}
        """Variance of the error states of this sensor at the start, by index in the state."""

        self.most_alike: int | None = None
        """Samples in a row that may read the same to the last bit: more are no measurement. None:
        any number; else it has `reading`."""

    def begin(self, state: NavigationState) -> NavigationState:
        """The state at the start with what this sensor adds to it."""
        return state

    def usable(self, sample: Any) -> bool:
        """Whether the sample says anything; a GPS under water does not."""
        return True

    def fault(self, sample: Any) -> str:
        """Why the sample cannot be one of a vehicle under water, beginning with the field; empty:
        it can.
        """
        return ""

    def out_of_reach(self, state: NavigationState) -> str:
        """Why the sensor cannot be expected to give samples here; empty: it should."""
        return ""

    def place(self, state: NavigationState) -> Array:
        """Where the sensor is, (3,) m, map_ned."""
        place: Array = state.position + quat_to_matrix(state.quaternion) @ self.lever
        return place

    def heading(self, sample: Any, level: Array) -> tuple[float, float] | None:
        """Heading (rad) and its variance, by which the filter can start; None: it says nothing.

        Args:
            sample: checked.
            level: attitude (4,) of the vehicle, whose heading is zero where it is not known.
        """
        return None

    def reading(self, sample: Any) -> Array:
        """The values of a sample, of which `most_alike` may be the same."""
        raise NotImplementedError(f"{type(self).__name__} lacks reading")

    def about(self, state: NavigationState, sample: Any, rate: Array) -> Linear:
        """The sample about the estimate, which is left as it is; arguments as of `correct`."""
        raise NotImplementedError(f"{type(self).__name__} follows, but lacks about")

    @abstractmethod
    def correct(self, state: NavigationState, sample: Any, rate: Array, gate: float) -> float:
        """Correct the state in place, unless the residual is beyond the gate.

        Args:
            state: at the sample's stamp; that of the IMU, as `NavigationState` says.
            sample: checked.
            rate: last reading of the gyro, (3,) rad/s.
            gate: largest squared Mahalanobis distance of the residual that is accepted.

        Returns:
            That distance; above `gate` nothing was changed. `uvms_observer.navigation.correct`
            does all this for an expected reading, its derivative and its noise.
        """
