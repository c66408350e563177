"""A sensor fails, or measures wrongly: what is asked for. `sensors.faults` does it.

A fault begins and ends with the stamps of the samples, and so between control ticks too.
"""

from abc import abstractmethod
from collections.abc import Sequence
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BeforeValidator, Field

from uvms_core.errors import ConfigError
from uvms_core.sensors import INERTIAL
from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_core.topics import ENCODERS
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.events.event import Effects, LastingEvent, check_name
from uvms_dynamics.simulation.events.measured import (
    check_quantity,
    is_attitude,
    quantities,
    sensor_names,
    signal_of,
)


def _as_list(value: Any) -> Any:
    is_list = isinstance(value, Sequence) and not isinstance(value, str)
    return value if is_list else (value,)


Size = Annotated[tuple[float, ...], BeforeValidator(_as_list), Field(min_length=1)]
"""A number for all axes, or one for each; of an attitude the rotation about the body axes, rad."""


def _not_negative(value: tuple[float, ...]) -> tuple[float, ...]:
    if min(value) < 0.0:
        raise ValueError(f"a standard deviation is >= 0, and this is {min(value):g}")
    return value


Deviation = Annotated[Size, AfterValidator(_not_negative)]
"""Standard deviation of an error, for all axes or one for each."""


KIND: Any = Field(description="what is wrong with it")


class SensorEvent(LastingEvent):
    """A fault of one sensor."""

    sensor: str = Field(description="name of the sensor in the vehicle file, or `encoders`")
    fault: str = KIND

    def check(self, vehicle: Vehicle) -> None:
        """The sensor's name, and the size of the fault."""
        check_name("sensor", self.sensor, sensor_names(vehicle))
        if self.sensor != ENCODERS:
            rate = vehicle.sensors.mounted[self.sensor].rate_hz
            self._check_concerned(to_nanoseconds(1.0 / rate))

    def check_times(self, step: int, period: int) -> None:
        """Encoders are read at control ticks."""
        if self.sensor == ENCODERS:
            self._check_concerned(period)

    def _check_concerned(self, period: int) -> None:
        """ConfigError unless a sample, of those that are due every `period` ns, has the fault."""
        first = -(-to_nanoseconds(self.at_s) // period) * period
        if self.until_s is not None and to_nanoseconds(self.until_s) <= first:
            raise ConfigError(
                f"until_s {self.until_s:g}: no sample of the {self.sensor}, which come every"
                f" {to_seconds(period):g} s, is measured from {self.at_s:g} s on and before; the"
                f" next is that of {to_seconds(first):g} s"
            )

    def begin(self, effects: Effects) -> None:
        """The sensors look at the stamps themselves."""

    def text(self) -> str:
        """In words."""
        own = {name: getattr(self, name) for name in type(self).model_fields if name in _SIZES}
        sizes = "".join(f", {name} {_plain(value)}" for name, value in own.items() if value)
        return f"sensor {self.sensor}: {self.fault}{sizes}"


class _Delivery(SensorEvent):
    """A fault of the delivery: navigation and the arm's loop start from the first samples."""

    def check(self, vehicle: Vehicle) -> None:
        """Whether the loop can do without the sensor."""
        super().check(vehicle)
        if self.sensor == ENCODERS and self.at_s == 0.0:
            raise ConfigError(
                "at_s 0: the loop starts from the first joint states; let the fault of the"
                " encoders begin later"
            )
        if self.sensor == INERTIAL.name and self.at_s == 0.0:
            raise ConfigError(
                f"at_s 0: navigation takes its attitude from the first sample of the {self.sensor};"
                " let the fault begin later"
            )


class _OfQuantities(SensorEvent):
    """A fault of what is measured."""

    field: str = Field(
        "",
        description="the quantity that is wrong, a field of the sample such as `velocity`; empty:"
        " all of them",
    )

    def check(self, vehicle: Vehicle) -> None:
        """The name of the quantity."""
        super().check(vehicle)
        if self.field:
            check_quantity(vehicle, self.sensor, self.field)


class _OfSize(_OfQuantities):
    """A fault with a size, which is that of one quantity."""

    field: str = Field(
        "",
        description="the quantity that is wrong, a field of the sample such as"
        " `angular_velocity`; may be left out where the sensor measures one alone",
    )

    @property
    @abstractmethod
    def size(self) -> tuple[float, ...]:
        """Of the error."""

    def check(self, vehicle: Vehicle) -> None:
        """A quantity, and as many numbers as it has."""
        super().check(vehicle)
        known = quantities(vehicle, self.sensor)
        if not self.field and len(known) > 1:
            raise ConfigError(
                f"field: the {self.sensor} measures {', '.join(known)}; name one of them"
            )
        count = known[self.field or next(iter(known))]
        if len(self.size) not in (1, count):
            raise ConfigError(
                f"{self.fault}: has {len(self.size)} numbers; {self.field or self.sensor} needs 1"
                f" or {count}"
            )


class SilentFault(_Delivery):
    """Nothing comes from the sensor."""

    fault: Literal["silent"] = KIND

    def check(self, vehicle: Vehicle) -> None:
        """Whether the loop can do without the sensor."""
        if self.sensor == ENCODERS:
            raise ConfigError(
                f"fault {self.fault!r}: the loop cannot go on without joint states; the encoders"
                " can have latency, zeros, stuck, bias, noise, outliers or scale"
            )
        super().check(vehicle)


class LatencyFault(_Delivery):
    """Samples come late, with the stamps of their measurement, and in order."""

    fault: Literal["latency"] = KIND
    latency_s: float = Field(gt=0.0, le=60.0, description="how much later they come, s")


class ZerosFault(_OfQuantities):
    """The sensor measures zero; an attitude is level and north."""

    fault: Literal["zeros"] = KIND


class StuckFault(_OfQuantities):
    """The sensor repeats its last measurement with new stamps."""

    fault: Literal["stuck"] = KIND


class BiasFault(_OfSize):
    """A constant error is added."""

    fault: Literal["bias"] = KIND
    bias: Size = Field(description="the error in the unit of the signal, a number or one an axis")

    @property
    def size(self) -> tuple[float, ...]:
        """Of the error."""
        return self.bias


class NoiseFault(_OfSize):
    """White noise is added to that of the sensor."""

    fault: Literal["noise"] = KIND
    std: Deviation = Field(description="its standard deviation in the unit of the signal")

    @property
    def size(self) -> tuple[float, ...]:
        """Of the error."""
        return self.std


class OutlierFault(_OfSize):
    """Some samples are far off: a normal error is added to them."""

    fault: Literal["outliers"] = KIND
    rate: float = Field(gt=0.0, le=1.0, description="share of the samples")
    std: Deviation = Field(description="standard deviation of the error in the unit of the signal")

    @property
    def size(self) -> tuple[float, ...]:
        """Of the error."""
        return self.std


class ScaleFault(_OfSize):
    """The measurement is multiplied by a factor; not an attitude."""

    fault: Literal["scale"] = KIND
    scale: Size = Field(description="the factor, a number or one an axis; 1: none")

    def check(self, vehicle: Vehicle) -> None:
        """A quantity that has a scale."""
        super().check(vehicle)
        if self.field and is_attitude(signal_of(vehicle, self.sensor), self.field):
            raise ConfigError(f"field {self.field!r}: an attitude has no scale")

    @property
    def size(self) -> tuple[float, ...]:
        """The factor."""
        return self.scale


_SIZES = ("field", "bias", "rate", "std", "latency_s", "scale")


def _plain(value: Any) -> str:
    if isinstance(value, tuple):
        return ", ".join(f"{each:g}" for each in value)
    return value if isinstance(value, str) else f"{value:g}"
