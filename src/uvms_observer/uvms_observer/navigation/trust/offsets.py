"""What is carried beside the filter's state: of a sensor that is off, or of the vehicle's speed.

There is room for one of them. A sensor that is off tells more by its changes than the vehicle
itself, so that it comes first; where it says nothing, that is what is left: what the thrusts give,
and where they are not known, or the model of the hull is wrong, the speed that it can have.
"""

from typing import NamedTuple

from uvms_core.signals import Array
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.trust import following, hull_model, lasting, top_speed
from uvms_observer.navigation.trust.hull_model import Driven, HullModel
from uvms_observer.navigation.trust.lasting import Lasting


class Offsets(NamedTuple):
    """The sensor that is off, if there is one; the speed where it is needed."""

    sensor: Lasting | None = None
    speed: Lasting | None = None
    driven: Driven | None = None
    wrong: bool = False  # whether the model of the hull is, since the velocity was last known
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


def bound_speed(
    state: NavigationState, offsets: Offsets, speed: float, model: HullModel, time: int
) -> Carried:
    """Where no sensor tells the velocity at `time` (ns), the vehicle does.

    Args:
        speed: std of its velocity over ground, m/s.
        model: what the thrusts give, where they are known.
    """
    kept = offsets.sensor
    if time - offsets.bounded < top_speed.EVERY or (kept is not None and kept.carried):
        return state, offsets
    offsets = offsets._replace(bounded=time)
    if not offsets.wrong and offsets.speed is None:
        state, driven, wrong = hull_model.aided(state, offsets.driven, model, time)
        offsets = offsets._replace(driven=driven, wrong=wrong)
    if offsets.driven is not None:
        return state, offsets
    state, now = top_speed.bounded(state, offsets.speed, speed, time)
    known = offsets.wrong and hull_model.velocity_std(state) < hull_model.LEAST_M_S
    return state, offsets._replace(speed=now, wrong=offsets.wrong and not known)


def _without_speed(state: NavigationState, offsets: Offsets) -> Carried:
    if offsets.driven is not None:
        state = lasting.without_offset(state)
    return following.stopped(state, offsets.speed), offsets._replace(speed=None, driven=None)
