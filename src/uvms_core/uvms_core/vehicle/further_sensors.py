"""Sections of sensors that installed packages bring, in the vehicle file."""

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field, ValidationError, create_model
from pydantic_core import InitErrorDetails, PydanticCustomError

from uvms_core import registry
from uvms_core.errors import PluginError
from uvms_core.vehicle.environment import Environment
from uvms_core.vehicle.parts import Part, Vector3


class Sensor(Part):
    """What every mounted sensor has; where its data are published, and in which axes."""

    type: str = Field(
        default="",
        description="kind of sensor, such as dvl, where the section has another name; empty: its"
        " name",
    )
    rate_hz: float = Field(gt=0.0, description="samples per second")
    position_m: Vector3 = Field(description="lever arm: sensor in the body frame, m")
    rpy_deg: Vector3 = Field(
        default=(0.0, 0.0, 0.0),
        description="mounting: roll, pitch and yaw of the sensor in the body frame, both with x"
        " forward, y starboard and z down, deg",
    )
    axes: Literal["frd", "flu"] = Field(
        default="frd",
        description="axes in which its data are: frd (forward, right, down) or flu (forward, left,"
        " up, as REP-103 has it)",
    )
    topic: str = Field(
        default="",
        description="topic of its messages, under the vehicle's namespace unless it begins with"
        " a slash; empty: sensors/NAME",
    )
    frame_id: str | None = Field(
        default=None,
        description="frame_id of its messages; none: NAME_link_fsd, or NAME_link with axes flu;"
        " of positions map_ned or map",
    )
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

    def check_site(self, site: Environment) -> None:
        """Whether the vehicle's environment says what the sensor needs; ValueError if not."""
        return None


class WorldSensor(Sensor):
    """A sensor of an attitude or of a place in the world."""

    world: Literal["ned", "enu"] = Field(
        default="ned",
        description="axes of the world in which its data are: ned (north, east, down) or enu (east,"
        " north, up, as REP-103 has it)",
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


def further_sections(
    data: Mapping[str, Any], built_in: Mapping[str, type[Sensor]]
) -> dict[str, Sensor]:
    """The sections, checked by their sensors' own classes.

    Args:
        data: sections by name; one with a `type` is of that kind, whatever its name.
        built_in: classes of the sections that every installation knows, by kind.

    Raises:
        ValidationError: with every fault at its place.
    """
    if not data:
        return {}
    classes, faults = {}, []
    for name, value in data.items():
        kind = kind_of(name, value)
        try:
            found, reason = built_in.get(kind) or section_class(kind), _unknown(kind, built_in)
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


def kind_of(name: str, section: Any) -> str:
    """Kind of the sensor of a section, which is plain data or checked."""
    given = section.get("type") if isinstance(section, Mapping) else getattr(section, "type", "")
    return given if isinstance(given, str) and given else name


def _unknown(name: str, built_in: Mapping[str, type[Sensor]]) -> str:
    choices = ", ".join(sorted({*built_in, *registry.names(registry.SENSORS)}))
    return (
        f"no installed package brings a sensor {name!r} (entry point in"
        f" {registry.SENSORS.group}); choose from {choices}"
    )
