"""What a run cost: load of the thrusters, authority left, impulse, and mechanical work.

Electrical energy is in `energy`.
"""

from collections.abc import Sequence

import numpy as np

from uvms_analysis.analysis import Analysis, at_common_stamps
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import Series
from uvms_core import topics
from uvms_core.signals import Array
from uvms_core.vehicle.thrusters import Thruster


def load_shares(run: Analysis) -> Array:
    """Thrust of each thruster over what it can give in that direction, (k, m), 0 to 1.

    Raises:
        LogError: the log lacks allocation or vehicle, or they do not fit together.
    """
    return shares(run.allocation.thrust, run.vehicle.thrusters)


def shares(thrust: Array, thrusters: Sequence[Thruster]) -> Array:
    """Thrusts (k, m) in N over what each thruster can give in that direction.

    Raises:
        LogError: there are others than m thrusters.
    """
    if thrust.shape[1:] != (len(thrusters),):
        raise LogError(f"{thrust.shape[1]} thrusts are allocated to {len(thrusters)} thrusters")
    ahead = np.array([item.ahead_n for item in thrusters])
    astern = np.array([-item.astern_n for item in thrusters])
    # One that cannot reverse is never asked to.
    return np.abs(thrust) / np.where(thrust >= 0.0, ahead, np.where(astern > 0.0, astern, ahead))


def authority_left(run: Analysis) -> Array:
    """What the busiest thruster has left at each tick, (k,), as a share of what it can give."""
    return 1.0 - load_shares(run).max(axis=1)


def total_thrust(run: Analysis) -> Array:
    """Sum of the sizes of all thrusts, (k,) N."""
    return np.abs(run.allocation.thrust).sum(axis=1)


def thruster_power(run: Analysis) -> tuple[Array, Array]:
    """Time (k,) and mechanical power of the thrusters on the vehicle, (k,) W: tau . nu.

    The wrench is that which the allocator gave, nu the velocity over ground of the `run`.
    """
    allocation, motion = at_common_stamps(run.allocation, run.truth)
    return allocation.time, np.einsum("ki,ki->k", allocation.achieved, motion.nu)


def arm_power(run: Analysis) -> tuple[Array, Array]:
    """Time (k,) and mechanical power of the joints' drives, (k,) W: commanded torque times rate."""
    command = run.log.series(topics.JOINT_COMMAND)
    command, joints = at_common_stamps(command, run.log.series(topics.JOINT_STATES))
    if command.effort.shape != joints.velocity.shape:
        raise LogError("joint commands and joint states have other numbers of joints")
    return command.time, np.einsum("kj,kj->k", command.effort, joints.velocity)


def torque_shares(run: Analysis) -> tuple[Array, Array]:
    """Time (k,) and commanded torque of each joint over its limit, (k, n)."""
    command = run.log.series(topics.JOINT_COMMAND)
    limits = np.array([joint.effort_limit_nm for joint in run.vehicle.arm.joints])
    if command.effort.shape[1:] != limits.shape:
        raise LogError(f"{command.effort.shape[1]} torques are commanded to {len(limits)} joints")
    return command.time, np.abs(command.effort) / limits


def integral(time: Array, values: Array) -> float:
    """Integral over time by the trapezoidal rule."""
    return float(np.trapezoid(values, time)) if len(time) > 1 else 0.0


def command_age(run: Analysis) -> tuple[Array, Array]:
    """Time (k,) and age of the older of the plant's two commands, (k,) s; NaN where it has none.

    In lockstep the age is one control period.
    """
    applied: Series = run.log.series(topics.APPLIED_THRUST)
    oldest = np.minimum(applied.thruster_command_stamp, applied.joint_command_stamp)
    age = (applied.stamps - oldest) / 1e9
    safe = np.asarray(applied.thruster_safe, bool) | np.asarray(applied.joint_safe, bool)
    return applied.time, np.where(safe, np.nan, age)
