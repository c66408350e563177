"""The Doppler velocity log: geometry_msgs/TwistWithCovarianceStamped, or marine_acoustic_msgs/Dvl.

The first is what most drivers publish; it does not say whether the velocity is over ground or
through the water, which the vehicle file declares then.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.mounting import Axes, Declared
from uvms_core.sensors.type import SensorType
from uvms_core.signals import BOTTOM_LOCK, WATER_LOCK, DvlSample, Lock
from uvms_core.topic import Conversion, Topic
from uvms_core.vehicle.sensors import Dvl


def to_message(topic: Topic, sample: DvlSample, names: Sequence[str]) -> Plain:
    """geometry_msgs/TwistWithCovarianceStamped; the angular part is marked unknown."""
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = sample.covariance
    covariance[[3, 4, 5], [3, 4, 5]] = fields.UNKNOWN
    twist = {"linear": parts.vector(sample.velocity), "angular": parts.vector(np.zeros(3))}
    return {
        "header": parts.header(topic, sample.stamp),
        "twist": {"twist": twist, "covariance": covariance.ravel()},
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> DvlSample:
    """From geometry_msgs/TwistWithCovarianceStamped; the angular part is not read."""
    fields.check_frame(topic, msg.header)
    covariance = fields.stated_covariance(topic, "twist.covariance", msg.twist.covariance, 6)
    return DvlSample(
        fields.stamp_of(msg.header.stamp),
        fields.vector(topic, "twist.twist.linear", msg.twist.twist.linear),
        covariance[:3, :3].copy(),
    )


_MODES: dict[int, Lock] = {1: BOTTOM_LOCK, 2: WATER_LOCK}
"""Of marine_acoustic_msgs/Dvl.velocity_mode."""
_MODE_OF = {lock: mode for mode, lock in _MODES.items()}


def to_marine(topic: Topic, sample: DvlSample, names: Sequence[str]) -> Plain:
    """marine_acoustic_msgs/Dvl; what concerns single beams is not known."""
    nothing = [0.0] * 4
    return {
        "header": parts.header(topic, sample.stamp),
        "velocity_mode": _MODE_OF[sample.lock],
        "dvl_type": 0,
        "velocity": parts.vector(sample.velocity),
        "velocity_covar": sample.covariance.ravel(),
        "altitude": 0.0,
        "course_gnd": float(np.arctan2(sample.velocity[1], sample.velocity[0])),
        "speed_gnd": float(np.hypot(sample.velocity[0], sample.velocity[1])),
        "num_good_beams": 4,
        "sound_speed": 0.0,
        "beam_ranges_valid": False,
        "beam_velocities_valid": False,
        "beam_unit_vec": [parts.vector(np.zeros(3)) for _ in nothing],
        "range": nothing,
        "range_covar": nothing,
        "beam_quality": nothing,
        "beam_velocity": nothing,
        "beam_velocity_covar": nothing,
    }


def from_marine(topic: Topic, msg: Any, names: Sequence[str]) -> DvlSample:
    """From marine_acoustic_msgs/Dvl; single beams are not read."""
    fields.check_frame(topic, msg.header)
    if msg.velocity_mode not in _MODES:
        raise SignalError(
            f"{topic.name}: velocity_mode is {msg.velocity_mode}; it must be 1 (bottom) or 2"
            " (water)"
        )
    return DvlSample(
        fields.stamp_of(msg.header.stamp),
        fields.vector(topic, "velocity", msg.velocity),
        fields.stated_covariance(topic, "velocity_covar", msg.velocity_covar, 3),
        _MODES[msg.velocity_mode],
    )


def declared(section: Dvl) -> Declared:
    """What the DVL measures against, where its messages do not say."""
    says = section.message == MARINE or section.lock == BOTTOM_LOCK
    return () if says else (("lock", section.lock),)


MARINE = "marine_acoustic_msgs/msg/Dvl"
TYPE = SensorType(
    "dvl",
    Dvl,
    DvlSample,
    "geometry_msgs/msg/TwistWithCovarianceStamped",
    to_message,
    from_message,
    axes=Axes(vectors=("velocity",), covariances=("covariance",)),
    declared=declared,
    others=((MARINE, Conversion(to_marine, from_marine)),),
)
