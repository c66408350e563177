"""What is carried beside the filter's state: of a sensor that is off, or of the vehicle's speed.

There is room for one of them. A sensor that is off tells more by its changes than the speed that a
vehicle can have, so that it comes first; where it says nothing, that is what is left.
"""

from typing import NamedTuple

from uvms_core.signals import Array
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.trust import following, lasting, top_speed
from uvms_observer.navigation.trust.lasting import Lasting


class Offsets(NamedTuple):
    """The sensor that is off, if there is one; the speed where it is needed."""

    sensor: Lasting | None = None
    speed: Lasting | None = None
    bounded: int = 0  # ns, when the speed was last looked at

    def of(self, name: str) -> Lasting | None:
        """What is kept of this sensor."""
        return self.sensor if self.sensor is not None and self.sensor.name == name else None


Carried = tuple[NavigationState, Offsets]
"""The state with what is carried beside it."""


def begin(
    state: NavigationState, offsets: Offsets, reading: Reading, sensor: Measurement, rate: Array
) -> Carried:
    """After a sample by which a sensor has jumped; the first one counts.

    Args:
        reading: the sample.
        sensor: whose it is.
        rate: (3,) of the vehicle, rad/s.
    """
    if offsets.sensor is not None:
        return state, offsets
    about, values = sensor.about(state, reading.sample, rate), sensor.reading(reading.sample)
    state, offsets = _without_speed(state, offsets)
    if not lasting.has_room(state):
        return state, offsets
    state, kept = following.begun(state, reading.name, about, values, reading.stamp)
    return state, offsets._replace(sensor=kept)


def follow(
    state: NavigationState,
    offsets: Offsets,
    reading: Reading,
    sensor: Measurement,
    rate: Array,
    speed: float,
) -> tuple[NavigationState, Offsets, Array]:
    """After a further sample of the sensor that is off; it is none of them if it is right again.

    Args:
        reading, sensor, rate: as `begin`.
        speed: std of what the vehicle can do, m/s.

    Returns:
        The state, what is carried beside it, and the residual (3,) before.
    """
    about, values = sensor.about(state, reading.sample, rate), sensor.reading(reading.sample)
    kept = offsets.sensor
    if kept is None:
        return state, offsets, about.residual
    if following.says_nothing(values, kept, about, speed):
        return *silence(state, offsets), about.residual
    if not kept.carried:
        state, offsets = _without_speed(state, offsets)
    state, after = following.followed(state, kept, about, values, reading.stamp)
    return state, offsets._replace(sensor=after), about.residual


def silence(state: NavigationState, offsets: Offsets) -> Carried:
    """After a sample of the sensor that is off which says nothing."""
    if offsets.sensor is None:
        return state, offsets
    state, kept = following.silent(state, offsets.sensor)
    return state, offsets._replace(sensor=kept)


def stop(state: NavigationState, offsets: Offsets) -> Carried:
    """It is no longer taken to be off."""
    return following.stopped(state, offsets.sensor), offsets._replace(sensor=None)


def bound_speed(state: NavigationState, offsets: Offsets, speed: float, time: int) -> Carried:
    """Where no sensor tells the velocity at `time` (ns), it is that of a vehicle: its std, m/s."""
    kept = offsets.sensor
    if time - offsets.bounded < top_speed.EVERY or (kept is not None and kept.carried):
        return state, offsets
    state, now = top_speed.bounded(state, offsets.speed, speed, time)
    return state, offsets._replace(speed=now, bounded=time)


def _without_speed(state: NavigationState, offsets: Offsets) -> Carried:
    return following.stopped(state, offsets.speed), offsets._replace(speed=None)
