"""Runs of the navigation filter on analytic motions, with the sensors of the tests."""

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from uvms_core.signals import Array, to_seconds
from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "uvms_observer"))

from hull_truth import Thrusts
from navigation_cases import CRUISE, FAULTS, outcome_of
from sensor_truth import Motion, Rig, Waves

VEHICLES = ("reference_auv", "bluerov2_alpha5")
SURVEY = Motion(
    Waves((0, 0, 10), (0.0, 0.0, 0.0), (8.0, 6.0, 0.5), (110.0, 73.0, 40.0)),
    Waves((0.02, -0.03, 0.2), amplitude=(0.04, 0.03, 0.8), period_s=(9.0, 13.0, 60.0)),
)
"""Lines that turn back, at half a metre a second."""
MOTIONS = {"cruise": CRUISE, "survey": SURVEY}

__all__ = ["CRUISE", "FAULTS", "MOTIONS", "SURVEY", "VEHICLES", "End", "fault_rows", "runs"]


class End(NamedTuple):
    """Of one run: squared distances at its end, and how far the estimate has drifted."""

    nees: dict[str, float]  # of position, velocity and attitude, 3 degrees of freedom each
    nis: dict[str, tuple[float, int]]  # squared distances of a last tick, degrees of freedom
    drift: float  # of the distance travelled


def runs(name: str, seeds: int, seconds: float, misalignment_deg: float) -> Iterator[End]:
    """Runs of a vehicle on CRUISE, whose start and mounting are as uncertain as the filter says."""
    vehicle = load_vehicle(name)
    for seed in range(seeds):
        rig = Rig(vehicle, CRUISE, seed, misalignment_deg=misalignment_deg)
        offset = 0.01 * np.random.default_rng([seed, 1]).standard_normal(3)
        start = tuple(map(float, CRUISE.position(0.0) + offset))
        config = NavigationConfig(initial_position_m=start)
        yield _end(vehicle, rig, NavigationFilter(vehicle, config), seconds)


def _end(vehicle: Vehicle, rig: Any, navigation: NavigationFilter, seconds: float) -> End:
    last: dict[str, Any] = {}
    nis, sizes = {}, {"imu": 3, "dvl": 3, "pressure": 1}
    start = None
    for frame in rig.frames(seconds):
        odometry = navigation.step(*frame)
        start = rig.motion.position(0.0) - odometry.position if start is None else start
        for name, size in sizes.items():
            tally = navigation._estimator.tallies[name]
            count = tally.accepted - (last[name].accepted if name in last else 0)
            if count and name in last:
                nis[name] = (tally.distance - last[name].distance, size * count)
            last[name] = tally
    motion, t = rig.motion, to_seconds(odometry.stamp)
    position = motion.position(t) - odometry.position
    turn = motion.rotation(t) * _rotation(odometry.quaternion).inv()
    velocity = motion.velocity(t, np.zeros(3)) - odometry.nu[:3]
    pose, twist = odometry.pose_covariance, odometry.twist_covariance
    nees = {
        "position": _squared(position, pose[:3, :3]),
        "velocity": _squared(velocity, twist[:3, :3]),
        "attitude": _squared(turn.as_rotvec(), pose[3:, 3:]),
    }
    way = motion.position(np.arange(0.0, t, 0.1))
    length = float(np.linalg.norm(np.diff(way, axis=0), axis=1).sum())
    return End(nees, nis, float(np.linalg.norm((position - start)[:2])) / length)


def _rotation(quaternion: Array) -> Any:
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(quaternion)


def _squared(error: Array, covariance: Array) -> float:
    return float(error @ np.linalg.solve(covariance, error))


class Row(NamedTuple):
    """A fault on a vehicle, over seeds and motions: the worst of each figure."""

    name: str
    error: float  # m, greatest of the position
    inside: float  # share of the ticks inside 3 sigma
    jump: float  # sigma, greatest from one tick to the next


def fault_rows(
    vehicle: Vehicle,
    seeds: int,
    motions: tuple[str | None, ...],
    only: str = "",
    thrusts: bool = False,
) -> Iterator[Row]:
    """The table of faults; a motion of None is the one that the fault has in the tests.

    Args:
        only: what the names of the faults begin with.
        thrusts: whether the filter is told them, by a hull that is unlike its own (`hull_truth`).
    """
    for name, fault in FAULTS.items():
        if not name.startswith(only):
            continue
        outcomes = []
        for seed in range(1, 1 + seeds):
            for motion in (MOTIONS[each] if each else fault.motion for each in motions):
                told = Thrusts(vehicle, motion, seed) if thrusts else None
                outcomes.append(outcome_of(fault, seed, vehicle, motion, told))
        yield Row(
            name,
            max(float(each.errors.max()) for each in outcomes),
            min(float((each.distances < SPHERE).mean()) for each in outcomes),
            max(float(each.jumps.max()) for each in outcomes),
        )


SPHERE = 3.76
"""Distance within which 99.73 % of the errors in space of a right filter are: 3 sigma of one."""
