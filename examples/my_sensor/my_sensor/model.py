"""The sensor: its section of the vehicle file, its signal, its message and its simulation.

The transponder on the vehicle answers a ship, which sends down where it is in the map.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field

from uvms_core.messages import fields, parts
from uvms_core.sensors import SensorType
from uvms_core.signals import Array3
from uvms_core.topic import WORLD_FRAME, Topic
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Sensor
from uvms_dynamics import quat_to_matrix
from uvms_dynamics.simulation.integrator import QUATERNION, VELOCITY
from uvms_dynamics.simulation.sensors import SensorModel, Trajectory


class Usbl(Sensor):
    """Section `sensors.usbl` of the vehicle file."""

    noise_m: float = Field(gt=0.0, description="white noise per axis and fix, m")


@dataclass(frozen=True)
class UsblFix:
    """One fix."""

    stamp: int
    position: Array3  # m, of the transponder in map_ned


def to_message(topic: Topic, fix: UsblFix, names: Sequence[str]) -> dict[str, Any]:
    """geometry_msgs/PointStamped in map_ned."""
    return {"header": parts.header(topic, fix.stamp), "point": parts.vector(fix.position)}


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> UsblFix:
    """From geometry_msgs/PointStamped."""
    fields.check_frame(topic, msg.header)
    return UsblFix(fields.stamp_of(msg.header.stamp), fields.vector(topic, "point", msg.point))


class UsblSensor(SensorModel):
    """Position of the transponder with white noise."""

    type = SensorType(
        "usbl",
        Usbl,
        UsblFix,
        "geometry_msgs/msg/PointStamped",
        to_message,
        from_message,
        frame=WORLD_FRAME,
    )

    def __init__(self, vehicle: Vehicle, section: Usbl, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._lever = np.array(section.position_m)
        self._noise = section.noise_m

    def sample(self, trajectory: Trajectory) -> tuple[UsblFix, ...]:
        """Fixes that are due on the trajectory."""
        return tuple(self._fix(trajectory, row) for row in trajectory.due(self.period))

    def _fix(self, trajectory: Trajectory, row: int) -> UsblFix:
        state = trajectory.states[row]
        place = state[:3] + quat_to_matrix(state[QUATERNION:VELOCITY]) @ self._lever
        noise = self._noise * self.rng.standard_normal(3)
        return UsblFix(trajectory.stamps[row], place + noise)
