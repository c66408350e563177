"""From the axes in which a driver publishes to those of the body and of map_ned, and back.

Inside, everything is forward-right-down and north-east-down, and a sensor's vectors are along the
axes of the body. A driver may publish forward-left-up and east-north-up (REP-103), and its sensor
may be mounted at any angle. Both are declared in the vehicle file, and turned here alone.

With C the rotation from the sensor's axes to the body's and W that from the world's axes to north,
east, down:

    v_body = C v,   Sigma_body = C Sigma C^T,   R_ned_body = W R C^T.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from uvms_core.rotations import (
    matrix_to_quat,
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    rpy_to_quat,
)
from uvms_core.signals import Array
from uvms_core.topic import Conversion, Topic
from uvms_core.vehicle.further_sensors import Sensor
from uvms_core.world_frames import R_MAP_MAP_NED

FLU = np.array([1.0, 0.0, 0.0, 0.0])
"""Quaternion from forward-left-up to forward-right-down: half a turn about x; its own inverse."""


@dataclass(frozen=True)
class Axes:
    """Which fields of a sample are along which axes; the others have none.

    Args:
        vectors: along the sensor's axes, (3,).
        covariances: about the same axes, (3, 3).
        attitudes: quaternions (4,), from the sensor's axes to the world's.
    """

    vectors: tuple[str, ...] = ()
    covariances: tuple[str, ...] = ()
    attitudes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Mounting:
    """How a sensor is mounted, and in which axes its driver publishes."""

    rpy_deg: tuple[float, float, float] = (0.0, 0.0, 0.0)
    axes: str = "frd"
    world: str = "ned"

    @cached_property
    def quaternion(self) -> Array:
        """(4,) from the axes of the data to those of the body."""
        turn: Array = rpy_to_quat(*np.radians(self.rpy_deg))
        return quat_multiply(turn, FLU) if self.axes == "flu" else turn

    @cached_property
    def to_body(self) -> Array:
        """C (3, 3): the axes of the data to those of the body."""
        matrix: Array = quat_to_matrix(self.quaternion)
        return matrix

    @cached_property
    def to_ned(self) -> Array:
        """(4,) quaternion of W: the world's axes of the data to those of map_ned."""
        if self.world == "ned":
            return np.array([0.0, 0.0, 0.0, 1.0])
        matrix: Array = matrix_to_quat(R_MAP_MAP_NED)
        return matrix

    def inwards(self, sample: Any, axes: Axes) -> Any:
        """A sample as it was published, in the axes of the body and of map_ned."""
        return self._turned(
            sample, axes, self.to_body, self.to_ned, quat_conjugate(self.quaternion)
        )

    def outwards(self, sample: Any, axes: Axes) -> Any:
        """The same the other way round."""
        return self._turned(sample, axes, self.to_body.T, self.to_ned, self.quaternion)

    @staticmethod
    def _turned(sample: Any, axes: Axes, C: Array, world: Array, right: Array) -> Any:
        """W is its own inverse, so that it is the same both ways."""
        values = {name: C @ getattr(sample, name) for name in axes.vectors}
        for name in axes.covariances:
            values[name] = C @ getattr(sample, name) @ C.T
        for name in axes.attitudes if getattr(sample, "oriented", True) else ():
            values[name] = quat_multiply(quat_multiply(world, getattr(sample, name)), right)
        return replace(sample, **values)


NO_AXES = Axes()
"""Of a sample that is the same in all axes."""
Declared = tuple[tuple[str, Any], ...]
AS_THE_BODY = Mounting()
"""Axes parallel to the body's and to those of map_ned: nothing is turned."""


def mounting_of(section: Sensor) -> Mounting:
    """That of a section of the vehicle file."""
    return Mounting(section.rpy_deg, section.axes, getattr(section, "world", "ned"))


@dataclass(frozen=True)
class _Outwards:
    mounting: Mounting
    axes: Axes
    inner: Conversion

    def __call__(self, topic: Topic, sample: Any, names: Sequence[str]) -> dict[str, Any]:
        return self.inner.to_message(topic, self.mounting.outwards(sample, self.axes), names)


@dataclass(frozen=True)
class _Inwards:
    mounting: Mounting
    axes: Axes
    inner: Conversion
    declared: Declared

    def __call__(self, topic: Topic, msg: Any, names: Sequence[str]) -> Any:
        sample = self.inner.from_message(topic, msg, names)
        if self.declared:
            sample = replace(sample, **dict(self.declared))
        return self.mounting.inwards(sample, self.axes)


def turned(
    conversion: Conversion, mounting: Mounting, axes: Axes, declared: Declared = ()
) -> Conversion:
    """A conversion whose messages are in the axes of the driver, its samples in our own.

    Args:
        conversion: that turns nothing.
        mounting: of the sensor.
        axes: of the fields of its samples.
        declared: fields of the samples that messages do not carry, with their values.
    """
    if not declared and (mounting == AS_THE_BODY or axes == NO_AXES):
        return conversion
    return Conversion(
        _Outwards(mounting, axes, conversion), _Inwards(mounting, axes, conversion, declared)
    )
