"""The navigation filter, eq. (20): gyrocompass and IMU, DVL, pressure and GPS to Odometry."""

from collections import deque
from collections.abc import Iterable, Sequence

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.signals import (
    DvlSample,
    GpsSample,
    ImuSample,
    Odometry,
    PressureSample,
    to_nanoseconds,
)
from uvms_core.vehicle import Vehicle
from uvms_observer.errors import NotAlignedError
from uvms_observer.navigation.estimator import Estimator
from uvms_observer.navigation.installation import installation
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.samples import NAMES, Sample, check, in_order
from uvms_observer.navigation.state import NavigationState


class NavigationFilter:
    """Error-state extended Kalman filter, eq. (20); derivation in docs/navigation.md.

    Inertial readings carry the state from stamp to stamp; every other reading corrects it at its
    own stamp, at the point where its sensor sits. A silent sensor only lets the covariance grow. A
    sample that comes late, but within the configured latency, is put where it belongs: the filter
    goes back to the step before it and takes all samples since again.

    Args:
        vehicle: sensors with lever arms and noise, water, datum of the map.
        config: start, gate, latency, factors on the noise.
    """

    def __init__(self, vehicle: Vehicle, config: NavigationConfig) -> None:
        self._estimator = Estimator(installation(vehicle, config), config)
        self._latency = to_nanoseconds(config.latency_s)
        self._history: deque[tuple[Estimator, list[Sample]]] = deque()
        self._stamp = -1  # of the last step
        self._newest: dict[str, int] = {}  # stamp of the newest sample, by sensor
        self.rejected = 0
        self.late = 0

    @property
    def state(self) -> NavigationState:
        """A copy of the state and its covariance."""
        return self._estimator.state.copied()

    def step(
        self,
        stamp: int,
        imu: Sequence[ImuSample],
        dvl: Sequence[DvlSample],
        pressure: Sequence[PressureSample],
        gps: Sequence[GpsSample],
    ) -> Odometry:
        """Take the samples since the last step, by their stamps; returns the estimate at `stamp`.

        Raises:
            SignalError: a stamp is out of order, a value is not finite or has a wrong shape. The
                filter is as it was before; `screen` takes such samples out beforehand.
            NotAlignedError: no IMU sample has come yet.
        """
        samples: list[Sample] = [*imu, *dvl, *pressure, *gps]
        good, faults = self.screen(stamp, samples)
        if faults:
            raise faults[0]
        if self._estimator.time is None and not imu:
            raise NotAlignedError("navigation has had no IMU sample yet; it needs an attitude")
        self._newest.update((NAMES[type(sample)], sample.stamp) for sample in good)
        self._stamp = stamp
        self._run(stamp, good)
        return self._estimator.odometry()

    def screen(
        self, stamp: int, samples: Iterable[Sample]
    ) -> tuple[list[Sample], list[SignalError]]:
        """The samples that `step` will take, in order, and an error for each that it will not.

        Raises:
            SignalError: the stamp itself is not after the last step's.
        """
        if stamp <= self._stamp:
            raise SignalError(
                f"stamp is {stamp} ns; it must be after the last step's, {self._stamp} ns"
            )
        newest, good, faults = dict(self._newest), [], []
        for sample in in_order(samples):
            try:
                self._check_stamp(sample, stamp, newest)
                check(sample)
            except SignalError as fault:
                faults.append(fault)
            else:
                newest[NAMES[type(sample)]] = sample.stamp
                good.append(sample)
        self.rejected += len(faults)
        return good, faults

    def status(self) -> dict[str, int | float]:
        """Counters for diagnostics, and the uncertainty (std) of the position in m."""
        counts: dict[str, int | float] = {"refused": self.rejected, "late": self.late}
        for name, tally in self._estimator.tallies.items():
            counts[f"{name}_accepted"] = tally.accepted
            counts[f"{name}_gated"] = tally.gated
            counts[f"{name}_recovered"] = tally.recovered
        variance = np.trace(self._estimator.state.covariance[:3, :3])
        counts["position_std_m"] = float(np.sqrt(variance))
        return counts

    def _check_stamp(self, sample: Sample, stamp: int, newest: dict[str, int]) -> None:
        name = NAMES[type(sample)]
        what = f"{name}.stamp is {sample.stamp} ns; it must"
        last, oldest = newest.get(name, -1), self._stamp - self._latency
        if sample.stamp > stamp:
            raise SignalError(f"{what} not be after the step's, {stamp} ns")
        if sample.stamp <= last:
            raise SignalError(f"{what} be after the last one's, {last} ns")
        if sample.stamp < oldest:
            raise SignalError(f"{what} not be before the filter's time less latency, {oldest} ns")

    def _run(self, stamp: int, samples: list[Sample]) -> None:
        samples = self._rewind(samples)
        self._history.append((self._estimator.copied(), samples))
        for sample in samples:
            self._estimator.take(sample)
        self._estimator.advance(stamp)
        while len(self._history) > 1 and _time(self._history[1][0]) < stamp - self._latency:
            self._history.popleft()

    def _rewind(self, samples: list[Sample]) -> list[Sample]:
        """Go back before the first sample; returns all samples to take from there, in order."""
        late = [sample for sample in samples if sample.stamp <= _time(self._estimator)]
        self.late += len(late)
        while samples and samples[0].stamp <= _time(self._estimator):
            self._estimator, again = self._history.pop()
            samples = in_order([*again, *samples])
        return samples


def _time(estimator: Estimator) -> int:
    return -1 if estimator.time is None else estimator.time
