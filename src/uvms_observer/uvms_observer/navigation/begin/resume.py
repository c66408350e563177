"""Where a filter begins that begins in the middle of a run: an estimate from before, or none.

A filter is started at the configured position at rest only at the beginning of a run. One that is
started later (its node was killed, or time jumped) goes on from the last estimate that it can get,
as uncertain as the vehicle's unknown motion since then has made it. Without one it says that it
does not know where it is, until a position is measured.
"""

from dataclasses import replace

import numpy as np

from uvms_core.signals import Array, Odometry, to_seconds
from uvms_dynamics.kernels.rotations import quat_to_matrix

OLDEST_S = 60.0
"""Oldest estimate to go on from, s: dead reckoning over a minute at unknown speed is worth less
than to say that nothing is known."""
BEGINNING_S = 1.0
"""A filter that starts within this of simulated time 0 starts with its run."""
EPOCH_S = 1e8
"""Stamps of years are those of a wall clock, which do not tell how long a run has lasted."""
UNKNOWN_SPEED_M_S = 0.5
"""How far from its last velocity a vehicle may have moved meanwhile, m/s (std): half its own speed
at survey, as it accelerates in either direction."""
LOST_M = 1e4
"""Std of a horizontal position that is not known, m: far beyond any mission, and small enough for
double precision beside millimetres."""
LOST_DEPTH_M = 100.0
"""The same for the depth, until the first pressure sample, m."""
LOST_SPEED_M_S = 3.0
"""The same for the velocity, until the first DVL sample, m/s: a vehicle at full speed."""


def is_in_the_middle(stamp: int) -> bool:
    """Whether a run whose time is this (ns) began a while ago."""
    return BEGINNING_S < to_seconds(stamp) < EPOCH_S


def fits(estimate: Odometry, stamp: int) -> bool:
    """Whether an estimate is one to go on from at this stamp, ns."""
    return 0.0 <= to_seconds(stamp - estimate.stamp) <= OLDEST_S


def carried(estimate: Odometry, stamp: int) -> Odometry:
    """The estimate at a later stamp (ns): straight ahead, less certain by its unknown motion."""
    age = to_seconds(stamp - estimate.stamp)
    R = quat_to_matrix(estimate.quaternion)
    position = estimate.position + R @ estimate.nu[:3] * age
    pose, twist = estimate.pose_covariance.copy(), estimate.twist_covariance.copy()
    speed = UNKNOWN_SPEED_M_S + float(np.linalg.norm(estimate.nu[:3]))
    pose[range(3), range(3)] += (speed * age) ** 2
    twist[range(3), range(3)] += min(speed, speed * age) ** 2
    return replace(
        estimate, stamp=stamp, position=position, pose_covariance=pose, twist_covariance=twist
    )


def placed(here: Odometry, estimate: Odometry, doubtful_s: float) -> Odometry:
    """`here`, about which nothing is known, where an estimate was at last.

    It has been wrong for `doubtful_s`, within which the vehicle cannot have gone farther than it
    can move.
    """
    moved = (LOST_SPEED_M_S * doubtful_s) ** 2
    pose = estimate.pose_covariance + moved * np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    return replace(here, position=estimate.position, pose_covariance=pose)


def doubted(estimate: Odometry, stamp: int) -> Odometry:
    """Where the estimate has it at a later stamp (ns), but neither place nor velocity is known."""
    here = carried(estimate, stamp)
    unknown = lost(stamp, here.position)
    return replace(
        here, pose_covariance=unknown.pose_covariance, twist_covariance=unknown.twist_covariance
    )


def lost(stamp: int, position: Array) -> Odometry:
    """Anywhere: the configured position (3,) with a covariance that says so."""
    pose = np.diag([LOST_M, LOST_M, LOST_DEPTH_M, np.pi, np.pi, np.pi]) ** 2
    twist = np.diag([LOST_SPEED_M_S] * 3 + [1.0] * 3) ** 2
    level = np.array([0.0, 0.0, 0.0, 1.0])
    return Odometry(stamp, position, level, np.zeros(6), pose, twist)
