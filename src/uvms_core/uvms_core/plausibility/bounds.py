"""The bounds of every signal that a node reads or writes, derived from the vehicle file.

They are wide: nothing that a vehicle can do is refused, be it capsizing, falling with ten times its
mass, drifting in a strong current or limp. What is refused cannot be a measurement or a command of
this vehicle at all. Covariances of samples have none: they may only let a sample count for less.
"""

from collections.abc import Callable
from typing import Any, get_type_hints

import numpy as np

from uvms_core import signals
from uvms_core.plausibility.agility import agility_of
from uvms_core.plausibility.continuity import (
    STEP_LIMITS,
    STEP_M,
    STEP_M_S,
    STEP_M_S2,
    STEP_RAD,
    Continuity,
)
from uvms_core.plausibility.rule import Bound, Rule, within
from uvms_core.plausibility.scale import Scale, scale_of
from uvms_core.signals import Array
from uvms_core.start import DEEPEST_M, MAP_M
from uvms_core.topic import Topic
from uvms_core.vehicle import Vehicle, joint_limits

ABOVE_M = 5.0
"""How far a pressure sensor gets out of the water, in metres of it: thrown up by waves. An estimate
of the depth may be above the surface by as much as it is uncertain, so it is not held to this."""
ANGLE_RAD = np.pi
"""A joint is this far beyond its limits only if its encoder is wrong: end stops are soft."""
COUNTLESS_RAD = 200 * np.pi
"""Angle of a joint without end stops: a hundred turns."""
SPECIFIC_FORCE = 20.0
"""Range of an inertial unit, in multiples of gravity: beyond what units of this class measure."""
ASKED = 1000.0
"""A law may ask for a wrench of this many times all thrust: a large error times a large gain, which
the allocator saturates. That of this project asks for a hundred times when the vehicle falls with
ten times its mass."""
ASKED_SUDDENLY = 300.0
"""And for this many times more or less than a tick before: such a vehicle, and a factor of 3."""
COMMANDED = 100.0
"""An actuator may be sent this many times its limit by a part that leaves saturation to it."""
SUDDENLY = 5.0
"""Change of such a command between two ticks, in limits: from full one way to full the other is 2;
what is far beyond makes no difference to an actuator that saturates."""
REVERSAL = 2.2
"""Change of a wrench that thrusters have, in all that they have: from full one way to full the
other, and rounding."""
EXPLAINED = 2.0
"""Change of an observed disturbance within a tick, in weight and all thrust."""
MEASURED = 20.0
"""A joint's measured effort against its drive's limit: impacts and friction come on top."""
UNEXPLAINED = 1000.0
"""A disturbance against the weight and all thrust: what an observer makes of an impact."""
ACCELERATION = 10.0
"""A planned acceleration, m/s^2 or rad/s^2, that every vehicle is granted beside its own."""
UNIT = 10.0
"""Of a quaternion, whose length `uvms_core.checks` holds to 1; wide, so that the quick test of the
whole signal is left to the other values."""
VARIANCE = 1e12
"""A std of a million of whatever unit: what filters write for `not known` is below it."""
SIGMAS = 10.0
"""An estimate may be corrected by this many std of its own uncertainty within a sample: a filter
that began at rest in a vehicle at 4 m/s, and refused its velocities for a while, is off by nine."""
ESTIMATE_M = 0.75
"""And by this without any."""
ESTIMATE = 0.05
"""The same for velocities and joint angles, m/s, rad/s and rad."""
ROUNDING = 1e-3
"""N and N m along axes in which the thrusters have nothing."""
UNSEEN_M_S = 2.0
"""And by this speed beside its own: the vehicle accelerates, and estimates of a speed are wrong."""
UNSEEN_RAD_S = 2.0
"""The same for a rate of turn."""
NOISES = 10.0
"""Noise of a sample in std: none in a billion is beyond it, with room for what a file omits."""
WORSE = 5.0
"""A sensor may be this many times noisier than its file says where a jump is all that tells: two
samples of such a sensor differ by more than `NOISES` of its std on every day."""
ANYTHING = 1e12
"""Bound of what nothing is known about: values of another package's sensor."""


def bounds_of(vehicle: Vehicle, topic: Topic) -> Rule:
    """The rule of a topic; one of finite numbers alone where its signal is not ours."""
    measured = _OF_SENSORS.get(topic.signal) if topic.signal is not None else None
    if measured is not None:
        return measured(vehicle, scale_of(vehicle), _section(vehicle, topic))
    make = _RULES.get(topic.signal) if topic.signal is not None else None
    if topic.name in _BY_TOPIC:
        make = _BY_TOPIC[topic.name]
    return _of_anything(topic.signal) if make is None else make(vehicle, scale_of(vehicle))


def _section(vehicle: Vehicle, topic: Topic) -> Any:
    """Section of the vehicle file with the sensor whose samples are on a topic."""
    return vehicle.sensors.mounted[topic.sensor]


def _imu(vehicle: Vehicle, scale: Scale, imu: Any) -> Rule:
    noise = NOISES * np.radians(max(imu.roll_pitch_noise_deg, imu.heading_noise_deg))
    force = SPECIFIC_FORCE * vehicle.environment.gravity_m_s2
    nu_dot, lever = agility_of(vehicle).nu_dot, float(np.linalg.norm(imu.position_m))
    # From the greatest one way to the greatest the other: an impact takes no time.
    felt = 2.0 * (nu_dot[:3] + lever * float(np.max(nu_dot[3:])))
    felt = felt + WORSE * NOISES * imu.accelerometer_noise_m_s2
    return Rule(
        (
            _quaternion("quaternion", noise),
            within(
                "angular_velocity",
                scale.rate,
                3,
                "rad/s",
                rate=agility_of(vehicle).nu_dot[3:],
                slack=WORSE * NOISES * np.radians(imu.gyro_noise_deg_s),
            ),
            within("linear_acceleration", force, 3, "m/s^2", rate=0.0, slack=felt),
        ),
        quaternion="quaternion",
        extra_slack=_own_turn,
    )


def _own_turn(imu: signals.ImuSample, elapsed_s: float) -> Array:
    """By how much the next sample may differ (10,): it turns, and may stop; so does gravity."""
    slack = np.zeros(4 + 3 + 3)
    rate = float(np.linalg.norm(imu.angular_velocity))
    slack[:4] = 0.5 * rate * elapsed_s
    slack[4:7] = rate
    slack[7:] = float(np.linalg.norm(imu.linear_acceleration)) * rate * elapsed_s
    return slack


def _dvl(vehicle: Vehicle, scale: Scale, dvl: Any) -> Rule:
    """The transducer moves with the hull: its lever times the rate comes on top."""
    nu_dot = agility_of(vehicle).nu_dot
    lever = float(np.linalg.norm(dvl.position_m))
    speed = scale.speed + scale.rate * lever
    rate = nu_dot[:3] + float(np.max(nu_dot[3:])) * lever
    slack = WORSE * NOISES * dvl.noise_m_s
    bound = within("velocity", speed, 3, "m/s", rate=rate, slack=slack)
    return Rule((bound,), extra_slack=_own_speed)


def _own_speed(dvl: signals.DvlSample, elapsed_s: float) -> Array:
    """By how much the next sample may differ (3,): what moves may stop, or turn about."""
    return np.full(3, float(np.linalg.norm(dvl.velocity)))


def _pressure(vehicle: Vehicle, scale: Scale, sensor: Any) -> Rule:
    sea = vehicle.environment
    metre = sea.water_density_kg_m3 * sea.gravity_m_s2
    noise = NOISES * (sensor.noise_pa + sensor.bias_pa)
    speed = scale.speed + scale.rate * float(np.linalg.norm(sensor.position_m))
    low = sea.atmospheric_pressure_pa - ABOVE_M * metre - noise
    high = sea.atmospheric_pressure_pa + DEEPEST_M * metre + noise
    jump = NOISES * sensor.noise_pa + 0.1 * metre
    return Rule((Bound("pressure", low, high, 1, "Pa", rate=metre * speed, slack=jump),))


def _gps(vehicle: Vehicle, scale: Scale, gps: Any) -> Rule:
    return Rule(
        (
            Bound("latitude_deg", -90.0, 90.0, 0, "deg", only_if="fix"),
            Bound("longitude_deg", -360.0, 360.0, 0, "deg", only_if="fix"),
            Bound("altitude", -DEEPEST_M, DEEPEST_M, 0, "m", only_if="fix"),
        )
    )


def _joints(vehicle: Vehicle, scale: Scale) -> Rule:
    n, encoders = vehicle.n_joints, vehicle.sensors.encoders
    noise = np.radians(NOISES * encoders.noise_deg + 2.0 * encoders.resolution_deg)
    rate_noise = np.radians(NOISES * encoders.rate_noise_deg_s)
    low, high = _angles(vehicle)
    rate = scale.joint_rate + rate_noise
    slack = WORSE * noise + ESTIMATE  # beside its motion
    q_ddot = agility_of(vehicle).q_ddot

    def own_motion(joints: signals.JointStates, elapsed_s: float) -> Array:
        """By how much the next sample may differ (3 n,): it moves, and a stop throws it back."""
        speed = float(np.linalg.norm(joints.velocity))
        moved = speed * elapsed_s + 0.5 * q_ddot * elapsed_s**2
        return np.concatenate([moved, np.full(n, 2.0 * speed), np.zeros(n)])

    return Rule(
        (
            Bound("position", low - noise, high + noise, n, "rad", rate=0.0, slack=slack),
            within(
                "velocity",
                rate,
                n,
                "rad/s",
                rate=q_ddot,
                slack=WORSE * rate_noise,
            ),
            within("effort", MEASURED * scale.effort, n, "N m"),
        ),
        extra_slack=own_motion,
    )


def _odometry(vehicle: Vehicle, scale: Scale) -> Rule:
    place = np.array([MAP_M, MAP_M, DEEPEST_M])
    rates = np.array([scale.speed] * 3 + [scale.rate] * 3)
    return Rule(
        (
            within("position", place, 3, "m", rate=UNSEEN_M_S, slack=ESTIMATE_M),
            _quaternion("quaternion", 0.0),
            within("nu", rates, 6, "m/s or rad/s", rate=agility_of(vehicle).nu_dot, slack=ESTIMATE),
            _covariance("pose_covariance", 6),
            _covariance("twist_covariance", 6),
        ),
        quaternion="quaternion",
        extra_slack=_own_motion,
    )


def _own_motion(odometry: signals.Odometry, elapsed_s: float) -> Array:
    """By how much the next estimate may differ (85,): its uncertainty, and its speed may stop."""
    slack = np.zeros(3 + 4 + 6 + 36 + 36)
    std = np.sqrt(np.maximum(odometry.pose_covariance.diagonal(), 0.0))
    speed = float(np.linalg.norm(odometry.nu[:3]))
    slack[:3] = SIGMAS * std[:3] + speed * elapsed_s
    turn = float(np.linalg.norm(odometry.nu[3:]))
    slack[3:7] = 0.5 * (SIGMAS * float(np.max(std[3:])) + turn * elapsed_s)
    rates = np.sqrt(np.maximum(odometry.twist_covariance.diagonal(), 0.0))
    slack[7:10] = SIGMAS * rates[:3] + speed
    slack[10:13] = SIGMAS * rates[3:] + turn
    return slack


def _command(vehicle: Vehicle, scale: Scale) -> Rule:
    force = _wrench(scale.force, scale)
    bound = within("wrench", ASKED * force, 6, "N or N m", rate=0.0, slack=ASKED_SUDDENLY * force)
    return Rule((bound,))


def _achieved(vehicle: Vehicle, scale: Scale) -> Rule:
    force, slack = _wrench(2.0 * scale.force, scale), REVERSAL * agility_of(vehicle).wrench
    return Rule((within("wrench", force, 6, "N or N m", rate=0.0, slack=slack + ROUNDING),))


def _disturbance(vehicle: Vehicle, scale: Scale) -> Rule:
    load = _wrench(scale.force + scale.weight, scale)
    bound = within("wrench", UNEXPLAINED * load, 6, "N or N m", rate=0.0, slack=EXPLAINED * load)
    return Rule((bound,))


def _budget(vehicle: Vehicle, scale: Scale) -> Rule:
    load = UNEXPLAINED * _wrench(scale.force + scale.weight, scale)
    parts = ("restoring", "coupling", "external", "external_sigma")
    return Rule([within(part, load, 6, "N or N m") for part in parts])


def _allocation(vehicle: Vehicle, scale: Scale) -> Rule:
    thrust, force = agility_of(vehicle).thrust, _wrench(scale.force, scale)
    return Rule(
        (
            within("thrust", COMMANDED * thrust, thrust.size, "N"),
            within("achieved", COMMANDED * force, 6, "N or N m"),
            within("residual", ASKED * force, 6, "N or N m"),
        )
    )


def _joint_command(vehicle: Vehicle, scale: Scale) -> Rule:
    slack = SUDDENLY * scale.effort
    bound = within(
        "effort", COMMANDED * scale.effort, vehicle.n_joints, "N m", rate=0.0, slack=slack
    )
    return Rule((bound,))


def _thruster_command(vehicle: Vehicle, scale: Scale) -> Rule:
    thrust = agility_of(vehicle).thrust
    slack = SUDDENLY * thrust
    bound = within("thrust", COMMANDED * thrust, thrust.size, "N", rate=0.0, slack=slack)
    return Rule((bound,))


def _reference(vehicle: Vehicle, scale: Scale) -> Rule:
    low, high = _angles(vehicle)
    place = np.array([MAP_M, MAP_M, DEEPEST_M])
    rates = np.array([scale.speed] * 3 + [scale.rate] * 3)
    agility = agility_of(vehicle)
    nu_dot = np.maximum(agility.nu_dot, ACCELERATION)
    limits = np.radians([joint.rate_limit_deg_s for joint in vehicle.arm.joints])
    strengths = np.radians([joint.acceleration_limit_deg_s2 for joint in vehicle.arm.joints])
    steps: dict[str, Array | float] = {
        "position": STEP_M,
        "quaternion": 0.5 * STEP_RAD,
        "nu": STEP_M_S,
        "nu_dot": STEP_M_S2,
        "q": STEP_RAD,
        "q_dot": STEP_LIMITS * limits,
        "q_ddot": STEP_LIMITS * strengths,
        "end_effector": STEP_M + scale.size * STEP_RAD,
    }
    return Rule(
        (
            within("position", place, 0, "m"),
            within("nu", rates, 0, "m/s or rad/s"),
            within("nu_dot", nu_dot, 0, "m/s^2 or rad/s^2"),
            Bound("q", low, high, 0, "rad"),
            within("q_dot", scale.joint_rate, 0, "rad/s"),
            within("q_ddot", agility.q_ddot, 0, "rad/s^2"),
            within("end_effector", place + scale.size, 0, "m"),
            Bound("times", 0.0, MAP_M, 0, "s"),
        ),
        step_fault=Continuity(steps).fault,
    )


def _of_anything(signal: type | None) -> Rule:
    """Finite numbers of any size that is not absurd, in every array and number of a signal."""
    hints = get_type_hints(signal) if signal is not None else {}
    fields = [name for name, hint in hints.items() if hint is float or "ndarray" in str(hint)]
    return Rule(tuple(within(name, ANYTHING, 0, "") for name in fields if name not in _NOT_NUMBERS))


_NOT_NUMBERS = ("saturated",)


def _quaternion(field: str, noise: float) -> Bound:
    """Components change by half the angle; the slack is for the estimate's corrections."""
    return within(field, UNIT, 4, "", rate=0.5 * UNSEEN_RAD_S, slack=0.1 + noise)


def _covariance(field: str, size: int) -> Bound:
    return within(field, VARIANCE, size * size, "", is_matrix=True)


def _angles(vehicle: Vehicle) -> tuple[Array, Array]:
    low, high = joint_limits(vehicle)
    free = np.array([joint.stop_stiffness_nm_rad == 0.0 for joint in vehicle.arm.joints])
    margin = np.where(free, COUNTLESS_RAD, ANGLE_RAD)
    return low - margin, high + margin


def _wrench(force: float, scale: Scale) -> Array:
    """A force along each axis, and its moment at the vehicle's size."""
    return force * np.array([1.0] * 3 + [scale.size] * 3)


_Maker = Callable[[Vehicle, Scale], Rule]
_OF_SENSORS: dict[Any, Callable[[Vehicle, Scale, Any], Rule]] = {
    signals.ImuSample: _imu,
    signals.DvlSample: _dvl,
    signals.PressureSample: _pressure,
    signals.GpsSample: _gps,
}
"""Of samples; the section of the vehicle file with their sensor comes third."""
_RULES: dict[Any, _Maker] = {
    signals.JointStates: _joints,
    signals.Odometry: _odometry,
    signals.JointCommand: _joint_command,
    signals.ThrusterCommand: _thruster_command,
    signals.Reference: _reference,
    signals.DisturbanceBudget: _budget,
    signals.Allocation: _allocation,
}
_BY_TOPIC: dict[str, _Maker] = {
    "wrench_command": _command,
    "wrench_achieved": _achieved,
    "disturbance": _disturbance,
}
"""Topics whose signals are of one class but of different size."""
