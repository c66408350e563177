"""Signals with one field at 0.9 of its absolute bound, and the harm that one tick of it does."""

from dataclasses import replace

import numpy as np

from uvms_core import topics
from uvms_core.plausibility import bounds_of
from uvms_core.vehicle import load_vehicle

VEHICLE = load_vehicle()
SHARE = 0.9
UPSIDE_DOWN = np.array([1.0, 0.0, 0.0, 0.0])
TOPICS = (
    topics.IMU,
    topics.DVL,
    topics.PRESSURE,
    topics.GPS,
    topics.JOINT_STATES,
    topics.ODOMETRY,
    topics.REFERENCE,
    topics.DISTURBANCE,
    topics.WRENCH_COMMAND,
    topics.WRENCH_ACHIEVED,
    topics.THRUSTER_COMMAND,
    topics.JOINT_COMMAND,
)
"""Every topic that a part of the loop reads."""
CASES = [
    *((topic, bound.field) for topic in TOPICS for bound in bounds_of(VEHICLE, topic).bounds),
    (topics.REFERENCE, "quaternion"),
]
"""Topics and fields; an attitude has no bound but its length, and is turned upside down."""
OFF_M, ROLL_DEG, ARM_DEG = 0.05, 2.0, 1.0
"""How far one tick of any value may push the vehicle (m), roll it and move a joint (degrees)."""


def at_the_bound(topic, signal, field):
    """The signal with a field at 0.9 of its greatest possible value, in all of its numbers."""
    given = getattr(signal, field)
    if field == "quaternion":
        return replace(signal, quaternion=np.broadcast_to(UPSIDE_DOWN, given.shape).copy())
    (bound,) = [each for each in bounds_of(VEHICLE, topic).bounds if each.field == field]
    more = {bound.only_if: True} if bound.only_if else {}
    if topic is topics.GPS:  # a whole fix, with one number at its bound
        more |= {"latitude_deg": 45.77, "longitude_deg": 126.68, "altitude": 0.0}
    if field == "times":
        value = given * SHARE
    elif field.endswith("covariance"):
        value = SHARE * float(bound.high) * np.eye(6)
    elif isinstance(given, float):
        middle, half = 0.5 * (bound.high + bound.low), 0.5 * (bound.high - bound.low)
        value = float(middle + SHARE * half)
    else:
        middle, half = 0.5 * (bound.high + bound.low), 0.5 * (bound.high - bound.low)
        value = np.broadcast_to(middle + SHARE * half, given.shape).copy()
    return replace(signal, **more | {field: value})


class Harm:
    """The greatest differences between two runs: vehicle (m), roll and joints (degrees)."""

    def __init__(self, truths, nominal):
        self.off_m = max(
            float(np.linalg.norm(a[0] - b[0])) for a, b in zip(truths, nominal, strict=True)
        )
        self.roll_deg = max(abs(a[1] - b[1]) for a, b in zip(truths, nominal, strict=True))
        self.arm_deg = max(
            float(np.degrees(np.abs(a[2] - b[2])).max())
            for a, b in zip(truths, nominal, strict=True)
        )

    @property
    def is_small(self):
        return self.off_m < OFF_M and self.roll_deg < ROLL_DEG and self.arm_deg < ARM_DEG

    def __repr__(self):
        return f"{self.off_m:.3f} m, roll {self.roll_deg:.2f} deg, arm {self.arm_deg:.2f} deg"


def pose(odometry, joints):
    """What `Harm` compares."""
    x, y, z, w = odometry.quaternion
    roll = np.degrees(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)))
    return odometry.position, float(roll), joints.position
