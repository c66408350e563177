"""The signals between the parts of the system, free of ROS: one frozen dataclass per topic.

Stamps are integer nanoseconds of simulation time, so that they compare exactly. Vectors are
float64 arrays in SI units. Poses are of the body frame (forward-starboard-down, `base_link_fsd`)
in the world frame (north-east-down, `map_ned`); quaternions are (x, y, z, w), body to world.
`nu` is Fossen's nu = (u, v, w, p, q, r) in the body frame. Wrenches are (X, Y, Z, K, M, N) in the
body frame, about its origin.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NANOSECONDS = 1_000_000_000


def to_nanoseconds(seconds: float) -> int:
    """Seconds to the nearest nanosecond."""
    return round(seconds * NANOSECONDS)


def to_seconds(stamp: int) -> float:
    """Nanoseconds to seconds."""
    return stamp / NANOSECONDS


@dataclass(frozen=True)
class ImuSample:
    """Gyrocompass and inertial unit; its axes are parallel to the body frame's."""

    stamp: int
    quaternion: Array  # (4,) body to map_ned
    angular_velocity: Array  # (3,) rad/s
    linear_acceleration: Array  # (3,) m/s^2, specific force (a - g) at the unit's own position
    orientation_covariance: Array  # (3, 3) rad^2, about the body axes
    angular_velocity_covariance: Array  # (3, 3)
    linear_acceleration_covariance: Array  # (3, 3)


@dataclass(frozen=True)
class DvlSample:
    """Doppler velocity log: velocity over ground of the transducer, body axes."""

    stamp: int
    velocity: Array  # (3,) m/s
    covariance: Array  # (3, 3)


@dataclass(frozen=True)
class PressureSample:
    """Absolute pressure at the sensor."""

    stamp: int
    pressure: float  # Pa, with the atmosphere's
    variance: float  # Pa^2


@dataclass(frozen=True)
class GpsSample:
    """GPS fix of the antenna; below the surface `fix` is False and the position is NaN."""

    stamp: int
    fix: bool
    latitude_deg: float
    longitude_deg: float
    altitude: float  # m above the surface
    covariance: Array  # (3, 3) m^2, north-east-down


@dataclass(frozen=True)
class JointStates:
    """Joint encoders (or the true joints, where the topic says so)."""

    stamp: int
    position: Array  # (n,) rad
    velocity: Array  # (n,) rad/s
    effort: Array  # (n,) N m


@dataclass(frozen=True)
class Odometry:
    """Pose and velocity of the vehicle, estimated or true."""

    stamp: int
    position: Array  # (3,) m, map_ned
    quaternion: Array  # (4,) body to map_ned
    nu: Array  # (6,) body frame, over ground
    pose_covariance: Array  # (6, 6) position in map_ned, rotation about the map_ned axes
    twist_covariance: Array  # (6, 6) body frame


@dataclass(frozen=True)
class Wrench:
    """Force and moment in the body frame, about its origin."""

    stamp: int
    wrench: Array  # (6,)


@dataclass(frozen=True)
class DisturbanceBudget:
    """What acts on the vehicle besides the thrusters, each part once."""

    stamp: int
    restoring: Array  # (6,) weight and buoyancy of hull and links, eq. (13)
    coupling: Array  # (6,) reaction of the arm at its base without weight and buoyancy, (14)-(15)
    external: Array  # (6,) what is left


@dataclass(frozen=True)
class Reference:
    """Where vehicle and joints shall be over the planner's next step, sampled at k times."""

    stamp: int  # of the first sample
    times: Array  # (k,) s after the stamp, increasing, from 0
    position: Array  # (k, 3)
    quaternion: Array  # (k, 4)
    nu: Array  # (k, 6)
    nu_dot: Array  # (k, 6)
    q: Array  # (k, n)
    q_dot: Array  # (k, n)
    q_ddot: Array  # (k, n)
    end_effector: Array  # (k, 3) where that puts the end effector, map_ned

    @property
    def end(self) -> int:
        """Stamp of the last sample."""
        return self.stamp + to_nanoseconds(float(self.times[-1]))


@dataclass(frozen=True)
class JointCommand:
    """Torque that each joint shall apply."""

    stamp: int
    effort: Array  # (n,) N m


@dataclass(frozen=True)
class ThrusterCommand:
    """Thrust that each thruster shall apply."""

    stamp: int
    thrust: Array  # (m,) N


@dataclass(frozen=True)
class Allocation:
    """What the allocator made of a commanded wrench."""

    stamp: int
    thrust: Array  # (m,) N
    achieved: Array  # (6,) wrench of these thrusts
    residual: Array  # (6,) commanded minus achieved
    saturated: NDArray[np.bool_]  # (m,)


@dataclass(frozen=True)
class PathGoal:
    """A path for the end effector: positions, with an orientation where the user gives one."""

    times: Array  # (k,) s after the start, increasing, from 0
    positions: Array  # (k, 3) m, map_ned
    orientations: Array  # (k, 4) tool to map_ned, or (0, 4) for none


@dataclass(frozen=True)
class JointGoal:
    """A motion of the joints, rest to rest between its points, while the vehicle holds its pose."""

    times: Array  # (k,) s after the start, increasing, > 0
    positions: Array  # (k, n) rad
