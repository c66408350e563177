"""The navigation filter on the trials: their inertial unit, and the motion capture as rare fixes.

The filter gets attitude, rates and specific force of the vehicle's own unit, and five times a
second the position of the motion capture; it is compared with the motion capture at its full rate.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from uvms_analysis.trials.convention import FLIP, position_down, quaternion
from uvms_analysis.trials.read import Trial
from uvms_analysis.trials.start import WINDOW_S
from uvms_core import registry
from uvms_core.sensors.position_fix import FixSample
from uvms_core.signals import Array, ImuSample, Odometry, to_nanoseconds
from uvms_core.vehicle import Vehicle, load_vehicle

FILTER = "error_state_ekf"
"""Name of the filter in the registry."""
FIX_RATE_HZ = 5.0
FIX_STD_M = 0.01
"""Std of a fix: the motion capture's outliers up to 3 cm were kept (README of the data), and they
must be inside three of these."""
START_SPEED_M_S = 0.1
"""Std of the velocity at the start: the vehicle floats nearly at rest."""
SIGMAS = 3.0
_NO_COVARIANCE = np.zeros((3, 3))


@dataclass(frozen=True)
class Navigated:
    """Errors of the estimated position over the accepted samples of a trial."""

    name: str
    error: Array  # (k, 3) m, estimated minus captured, map axes
    std: Array  # (k, 3) m, as the filter states it
    gated: int  # fixes that the filter did not use
    fixes: int

    @property
    def distance(self) -> Array:
        """Length of the error, (k,) m."""
        return np.asarray(np.linalg.norm(self.error, axis=1))

    @property
    def share_inside(self) -> float:
        """Share of samples whose error is within three standard deviations along all axes."""
        return float((np.abs(self.error) <= SIGMAS * self.std).all(axis=1).mean())


def is_installed() -> bool:
    """Whether the package with the filter is there."""
    return FILTER in registry.names(registry.NAVIGATION_FILTERS)


def navigated_vehicle(vehicle: str, trial: Trial) -> Vehicle:
    """The vehicle of a file as it was in a trial: its unit's rate is that of the recording."""
    fix = {"rate_hz": FIX_RATE_HZ, "position_m": [0.0, 0.0, 0.0], "noise_m": FIX_STD_M}
    rate = 1.0 / float(np.median(np.diff(trial.t)))
    return load_vehicle(vehicle, {"sensors.imu.rate_hz": rate, "sensors.position_fix": fix})


def navigate(trial: Trial, vehicle: Vehicle) -> Navigated:
    """Run the filter over a trial that has an inertial unit.

    Args:
        trial: with `inertial`.
        vehicle: of `navigated_vehicle`.
    """
    position, stamps = position_down(trial.position), _stamps(trial)
    begin, last = int(np.flatnonzero(trial.accepted)[0]), -1
    navigation: Any = registry.load(registry.NAVIGATION_FILTERS, FILTER)(vehicle)
    navigation.resume(_start(stamps[begin], position[begin]))
    errors, stds, fixes = [], [], 0
    for stamp, imu, place, accepted in zip(
        stamps[begin:], _readings(trial, stamps, begin), position[begin:], trial.accepted[begin:],
        strict=True,
    ):  # fmt: skip
        slot = int(stamp * FIX_RATE_HZ * 1e-9 + 1e-6)
        fix = [FixSample(stamp, place, _NO_COVARIANCE)] if accepted and slot > last else []
        last, fixes = (slot, fixes + 1) if fix else (last, fixes)
        odometry, _ = navigation.step_screened(stamp, {"imu": [imu], "position_fix": fix})
        if accepted:
            errors.append(odometry.position - place)
            stds.append(np.sqrt(np.diagonal(odometry.pose_covariance)[:3]))
    gated = int(navigation.status().get("position_fix_gated", 0))
    return Navigated(trial.name, np.array(errors), np.array(stds), gated, fixes)


def _stamps(trial: Trial) -> list[int]:
    """Stamps from a period after zero on, ns."""
    period = float(np.median(np.diff(trial.t)))
    return [to_nanoseconds(t - trial.t[0] + period) for t in trial.t]


def _start(stamp: int, position: Array) -> Odometry:
    """At the first fix, nearly at rest; the filter takes the attitude from its unit."""
    pose = np.diag([FIX_STD_M**2] * 3 + [1.0] * 3)
    twist = np.diag([START_SPEED_M_S**2] * 3 + [1.0] * 3)
    level = np.array([0.0, 0.0, 0.0, 1.0])
    return Odometry(stamp, position, level, np.zeros(6), pose, twist)


def _readings(trial: Trial, stamps: list[int], begin: int) -> Iterator[ImuSample]:
    """The unit's readings from index `begin` on, in our axes, its heading that of the map."""
    inertial = trial.inertial
    if inertial is None:
        raise ValueError(f"{trial.name} has no inertial unit")
    attitude = inertial[:, :3] + np.array([0.0, 0.0, _heading_offset(trial, inertial)])
    rates, forces = trial.gyro * FLIP, inertial[:, 3:] * FLIP
    none = _NO_COVARIANCE
    for k in range(begin, len(stamps)):
        yield ImuSample(stamps[k], quaternion(attitude[k]), rates[k], forces[k], none, none, none)


def _heading_offset(trial: Trial, inertial: Array) -> float:
    """From the unit's heading to that of the motion capture at the start, degrees.

    The two have arbitrary zeros; the first accepted samples align them, no later ones do.
    """
    index = np.flatnonzero(trial.accepted)
    index = index[trial.t[index] <= trial.t[index[0]] + WINDOW_S]
    turn = np.radians(trial.attitude[index, 2] - inertial[index, 2])
    return float(np.degrees(np.angle(np.exp(1j * turn).mean())))
