"""The signals between the parts of the system, free of ROS: one frozen dataclass each.

Stamps are integer nanoseconds of simulation time, so that they compare exactly. Vectors are
float64 arrays in SI units. Poses are of the body frame (forward-starboard-down, `base_link_fsd`)
in the world frame (north-east-down, `map_ned`); quaternions are (x, y, z, w), body to world.
`nu` is Fossen's nu = (u, v, w, p, q, r) in the body frame. Wrenches are (X, Y, Z, K, M, N) in the
body frame, about its origin.

The annotations of the fields are the rules by which `uvms_core.checks` checks a signal; plain
floats must be finite, and plain arrays are checked only on the way from a message (the covariances
of samples, which only add to the noise that the vehicle file states; zeros where none is given).
"""

from dataclasses import dataclass, field, replace
from typing import Annotated, Final, Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Shape:
    """Rule of an array: float64, finite, of these sizes.

    A size is a number or a letter. A letter means the same number, at least 1, wherever it occurs
    in a signal: `n` joints, `m` thrusters, `k` samples over time.

    Args:
        sizes: of each dimension.
        unit: the vector, or each row, has unit length.
        increasing: the values increase from 0.
    """

    sizes: tuple[int | str, ...]
    unit: bool = False
    increasing: bool = False


@dataclass(frozen=True)
class OnlyIf:
    """Rule of a number that must be finite only where another field of the signal is true."""

    field: str


Array3 = Annotated[Array, Shape((3,))]
Array6 = Annotated[Array, Shape((6,))]
Array6x6 = Annotated[Array, Shape((6, 6))]
Quaternion = Annotated[Array, Shape((4,), unit=True)]
ByJoint = Annotated[Array, Shape(("n",))]
ByThruster = Annotated[Array, Shape(("m",))]
Times = Annotated[Array, Shape(("k",), increasing=True)]
Array3s = Annotated[Array, Shape(("k", 3))]
Array6s = Annotated[Array, Shape(("k", 6))]
Quaternions = Annotated[Array, Shape(("k", 4), unit=True)]
ByJoints = Annotated[Array, Shape(("k", "n"))]
NumberWithFix = Annotated[float, OnlyIf("fix")]
NumberOrNan = Annotated[float, "NaN where it is not known"]

NANOSECONDS = 1_000_000_000


def to_nanoseconds(seconds: float) -> int:
    """Seconds to the nearest nanosecond."""
    return round(seconds * NANOSECONDS)


def to_seconds(stamp: int) -> float:
    """Nanoseconds to seconds."""
    return stamp / NANOSECONDS


@dataclass(frozen=True)
class ImuSample:
    """Gyrocompass and inertial unit, in body axes."""

    stamp: int
    quaternion: Quaternion  # body to map_ned
    angular_velocity: Array3  # rad/s
    linear_acceleration: Array3  # m/s^2, specific force (a - g) at the unit's own position
    orientation_covariance: Array  # (3, 3) rad^2, about the body axes
    angular_velocity_covariance: Array  # (3, 3)
    linear_acceleration_covariance: Array  # (3, 3)
    oriented: bool = True  # whether the attitude was measured; if not, the quaternion is level


Lock = Literal["bottom", "water"]
"""What a DVL may measure against."""
BOTTOM_LOCK: Final = "bottom"
WATER_LOCK: Final = "water"  # files with numba kernels take it


@dataclass(frozen=True)
class DvlSample:
    """Doppler velocity log: velocity of the transducer, body axes, over what it has locked on."""

    stamp: int
    velocity: Array3  # m/s
    covariance: Array  # (3, 3)
    lock: Lock = BOTTOM_LOCK


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
    latitude_deg: NumberWithFix
    longitude_deg: NumberWithFix
    altitude: NumberWithFix  # m above the surface
    covariance: Array  # (3, 3) m^2, north-east-down


@dataclass(frozen=True)
class JointStates:
    """Joint encoders (or the true joints, where the topic says so)."""

    stamp: int
    position: ByJoint  # rad
    velocity: ByJoint  # rad/s
    effort: ByJoint  # N m


NOTHING_YET = -1
"""The stamp of a sample that has not come, ns."""


@dataclass(frozen=True)
class SensorGaps:
    """Sensors whose samples are not those that are due by their rates, at one control tick.

    In lockstep navigation waits for what is due; it then waits for the newest sample that is here.
    """

    stamp: int
    sensors: tuple[str, ...]  # names of the vehicle file
    newest: tuple[int, ...]  # stamp of the newest sample that has come of each, ns


@dataclass(frozen=True)
class Odometry:
    """Pose and velocity of the vehicle, estimated or true."""

    stamp: int
    position: Array3  # m, map_ned
    quaternion: Quaternion  # body to map_ned
    nu: Array6  # body frame, over ground
    pose_covariance: Array6x6  # position in map_ned, rotation about the map_ned axes
    twist_covariance: Array6x6  # body frame


@dataclass(frozen=True)
class Wrench:
    """Force and moment in the body frame, about its origin."""

    stamp: int
    wrench: Array6


@dataclass(frozen=True)
class Payload:
    """What the gripper holds, as estimated from the forces that vehicle and joints feel."""

    held: bool  # confirmed: taken into the models of controller, observer and planner
    mass: float  # kg, with the water that it carries along
    mass_sigma: float  # kg, standard deviation
    weight: float  # N, in water, positive down
    weight_sigma: float  # N
    position: Array3  # m, its centre in the tool frame
    position_sigma: Array3  # m


@dataclass(frozen=True)
class ThrusterHealth:
    """How much of its command each thruster gives, as estimated from the motion of the vehicle."""

    effectiveness: ByThruster  # share of the command: 1 is whole, 0 is dead
    sigma: ByThruster  # standard deviation


def _six_zeros() -> Array:
    return np.zeros(6)


def _nothing() -> Array:
    return np.empty(0)


def _no_directions() -> Array:
    return np.empty((0, 3))


@dataclass(frozen=True)
class DisturbanceBudget:
    """What acts on the vehicle besides the thrusters, each part once, and what explains it."""

    stamp: int
    restoring: Array6  # weight and buoyancy of hull and links, eq. (13)
    coupling: Array6  # reaction of the arm at its base without weight and buoyancy, (14)-(15)
    external: Array6  # what is left
    external_sigma: Array6 = field(default_factory=_six_zeros)  # its std; zero: not known
    payload: Payload | None = None  # None: the observer does not look for one
    thrusters: ThrusterHealth | None = None  # None: the observer does not look at them


@dataclass(frozen=True)
class PlannedDisturbance:
    """What a planned motion does to the vehicle, at the k times of its reference, body frame.

    By the planner's model, payload included, for a level vehicle in still water.
    """

    restoring: Array6s  # weight and buoyancy of hull, links and payload, eq. (13)
    coupling: Array6s  # reaction of the arm at its base without weight and buoyancy, (14)-(15)


@dataclass(frozen=True)
class Reference:
    """Where vehicle and joints are to be over the planner's next step, sampled at k times."""

    stamp: int  # of the first sample
    times: Times  # s after the stamp, increasing, from 0
    position: Array3s
    quaternion: Quaternions
    nu: Array6s
    nu_dot: Array6s
    q: ByJoints
    q_dot: ByJoints
    q_ddot: ByJoints
    end_effector: Array3s  # where that puts the end effector, map_ned
    disturbance: PlannedDisturbance | None = None  # None: the planner does not say

    @property
    def end(self) -> int:
        """Stamp of the last sample."""
        return self.stamp + to_nanoseconds(float(self.times[-1]))


@dataclass(frozen=True)
class JointCommand:
    """Torque that each joint is to apply."""

    stamp: int
    effort: ByJoint  # N m


@dataclass(frozen=True)
class ThrusterCommand:
    """Thrust that each thruster is to apply."""

    stamp: int
    thrust: ByThruster  # N


@dataclass(frozen=True)
class Allocation:
    """What the allocator made of a commanded wrench."""

    stamp: int
    thrust: ByThruster  # N
    achieved: Array6  # wrench of these thrusts, each with its effectiveness
    residual: Array6  # commanded minus what the thrusters will give; where no lag is made up for,
    # commanded minus achieved
    saturated: NDArray[np.bool_]  # (m,)
    effectiveness: Array = field(default_factory=_nothing)
    """(m,) share of its command that each thruster is taken to give; (0,): all of it."""


@dataclass(frozen=True)
class Stability:
    """The Lyapunov function of the vehicle's control loop, by eq. (27)-(29)."""

    stamp: int
    lyapunov: float  # V of (27)
    lyapunov_rate: float  # its rate, 1/s of the same unit
    demand: float  # right side of the condition below (29): what motion and disturbance ask for
    supply: float  # left side: what the thrusters' wrench gives

    @property
    def holds(self) -> bool:
        """Whether the condition below (29) holds."""
        return self.supply >= self.demand


@dataclass(frozen=True)
class AppliedThrust:
    """What the plant's thrusters do at the stamp, and which commands it used to get there.

    A command that is `safe` came from the plant itself, because none from outside could be used.
    """

    stamp: int
    thrust: ByThruster  # N, at the stamp
    commanded: ByThruster  # N, over the control period that ends at the stamp
    thruster_command_stamp: int
    joint_command_stamp: int
    thruster_safe: bool
    joint_safe: bool


@dataclass(frozen=True)
class BatteryState:
    """What a battery has left and what is taken from it."""

    stamp: int
    voltage: float  # V, at its terminals
    current: NumberOrNan  # A, mean since the last sample; negative while it is discharged
    charge: NumberOrNan  # Ah, that are left
    capacity: NumberOrNan  # Ah, when full
    percentage: NumberOrNan  # share of the capacity that is left, 0 to 1, as the message has it

    @property
    def power(self) -> float:
        """Power that is taken from it, W."""
        return -self.voltage * self.current


BY_THRUSTER = (ThrusterCommand, Allocation, AppliedThrust, DisturbanceBudget)
"""Signals whose messages carry the names of thrusters; those of others carry joints' or none."""


@dataclass(frozen=True)
class PathGoal:
    """A path for the end effector: positions, with an orientation where the user gives one."""

    times: Array  # (k,) s after the start, increasing, from 0
    positions: Array  # (k, 3) m, map_ned
    orientations: Array  # (k, 4) tool to map_ned, or (0, 4) for none
    tool_axis: Array = field(default_factory=_nothing)
    """(3,) unit vector in the tool's axes that is to point along `axis_directions`; (0,): none."""
    axis_directions: Array = field(default_factory=_no_directions)
    """(k, 3) unit vectors in map_ned; (0, 3) without `tool_axis`."""
    time_scale_max: float = 1.0
    """How many times as long the path may take where it is too fast; 1: as long as it says."""

    def slowed(self, factor: float) -> "PathGoal":
        """The same way in `factor` times the time, at a `factor`-th of the speed everywhere."""
        return replace(self, times=self.times * factor)


@dataclass(frozen=True)
class ToolTarget:
    """Where the end effector is to go next, without a goal; another may come at any time."""

    stamp: int  # ns
    position: Array3  # m, map_ned


@dataclass(frozen=True)
class JointGoal:
    """A motion of the joints, rest to rest between its points, while the vehicle holds its pose."""

    times: Array  # (k,) s after the start, increasing, > 0
    positions: Array  # (k, n) rad


@dataclass(frozen=True)
class PoseGoal:
    """A pose that the vehicle goes to and holds, level, while the joints stay as they are."""

    position: Array  # (3,) m, map_ned
    quaternion: Array  # (4,) body to map_ned; level
    duration_s: float = 0.0  # of the way there; 0: as short as the limits allow
    hold_s: float = 0.0  # to stay there before the goal ends
    speed_max_m_s: float = 0.0  # on the way; 0: what the limits allow


Goal = PathGoal | JointGoal | PoseGoal
"""What the planner may be asked for."""
