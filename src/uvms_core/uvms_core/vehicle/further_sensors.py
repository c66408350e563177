"""Sections of sensors that installed packages bring, in the vehicle file."""

from collections.abc import Mapping
from typing import Any

from pydantic import Field, ValidationError, create_model
from pydantic_core import InitErrorDetails, PydanticCustomError

from uvms_core import registry
from uvms_core.errors import PluginError
from uvms_core.vehicle.parts import Part, Vector3


class Sensor(Part):
    """What every mounted sensor has."""

    rate_hz: float = Field(gt=0.0, description="samples per second")
    position_m: Vector3 = Field(description="lever arm: sensor in the body frame, m")
    latency_s: float = Field(
        default=0.0,
        ge=0.0,
        le=10.0,
        description="a sample comes this long after its own stamp, s; those of t = 0 come at once",
    )
    drop_out_rate: float = Field(
        default=0.0,
        ge=0.0,
        le=1.0,
        description="probability that a sample does not come; those of t = 0 always do",
    )


def section_class(name: str) -> type[Sensor] | None:
    """Class of a further sensor's section; None where no package registers the sensor.

    Raises:
        PluginError: the sensor's class cannot be imported, or has no section.
    """
    if name not in registry.names(registry.SENSORS):
        return None
    kind = getattr(registry.load(registry.SENSORS, name), "type", None)
    section = getattr(kind, "section", None)
    if not (isinstance(section, type) and issubclass(section, Sensor)):
        raise PluginError(
            f"sensor {name!r}: type.section of its class must be a subclass of"
            f" uvms_core.vehicle.sensors.Sensor; it is {section!r}"
        )
    return section


def further_sections(data: Mapping[str, Any], built_in: tuple[str, ...]) -> dict[str, Sensor]:
    """The sections, checked by their sensors' own classes.

    Raises:
        ValidationError: with every fault at its place.
    """
    if not data:
        return {}
    classes, faults = {}, []
    for name, value in data.items():
        try:
            found, reason = section_class(name), _unknown(name, built_in)
        except PluginError as fault:
            found, reason = None, str(fault)
        if found is None:
            error = PydanticCustomError("unknown_sensor", "{reason}", {"reason": reason})
            faults.append(InitErrorDetails(type=error, loc=(name,), input=value))
        else:
            classes[name] = (found, ...)
    if faults:
        raise ValidationError.from_exception_data("sensors", faults)
    model: Any = create_model("FurtherSensors", **classes)  # type: ignore[call-overload]
    return dict(model.model_validate(dict(data)))


def _unknown(name: str, built_in: tuple[str, ...]) -> str:
    choices = ", ".join(sorted({*built_in, *registry.names(registry.SENSORS)}))
    return (
        f"no installed package brings a sensor {name!r} (entry point in"
        f" {registry.SENSORS.group}); choose from {choices}"
    )
