"""Which event a mapping is: `payload`, `thruster`, `sensor`, `wrench` or `joint`."""

from collections.abc import Iterable, Mapping
from typing import Annotated, Any

from pydantic import BeforeValidator, Discriminator, Field, Tag

from uvms_core.config import Config, validated
from uvms_core.errors import ConfigError
from uvms_core.signals import to_seconds
from uvms_core.vehicle import Vehicle
from uvms_core.yaml_text import parse_yaml
from uvms_dynamics.simulation.events.event import Event
from uvms_dynamics.simulation.events.joint import JointEvent
from uvms_dynamics.simulation.events.payload import RELEASE, PayloadEvent
from uvms_dynamics.simulation.events.sensor import (
    BiasFault,
    LatencyFault,
    NoiseFault,
    OutlierFault,
    ScaleFault,
    SensorEvent,
    SilentFault,
    StuckFault,
    ZerosFault,
)
from uvms_dynamics.simulation.events.thruster import ThrusterEvent
from uvms_dynamics.simulation.events.wrench import WrenchEvent

KINDS: dict[str, type[Event]] = {
    "payload": PayloadEvent,
    "thruster": ThrusterEvent,
    "wrench": WrenchEvent,
    "joint": JointEvent,
}
"""By the word that an event of the kind has."""
SENSOR = "sensor"
FAULTS: dict[str, type[SensorEvent]] = {
    "silent": SilentFault,
    "zeros": ZerosFault,
    "stuck": StuckFault,
    "bias": BiasFault,
    "noise": NoiseFault,
    "outliers": OutlierFault,
    "latency": LatencyFault,
    "scale": ScaleFault,
}
"""Kinds of events of a sensor, by the value of `fault`."""
_WORDS = (*KINDS, SENSOR)


def _checked(event: Any) -> Any:
    """The event, if it says of which kind it is."""
    if isinstance(event, Event):
        return event
    if not isinstance(event, Mapping):
        raise ValueError(f"an event is a mapping with at_s and one of {', '.join(_WORDS)}")
    words = [word for word in _WORDS if word in event]
    if len(words) != 1:
        has = f"has {' and '.join(words)}" if words else f"has {', '.join(map(str, event))}"
        raise ValueError(f"an event has exactly one of {', '.join(_WORDS)}; this one {has}")
    if words == [SENSOR] and "fault" not in event:
        raise ValueError(f"fault: required; choose one of {', '.join(FAULTS)}")
    if words == [SENSOR] and event["fault"] not in FAULTS:
        raise ValueError(f"fault {event.get('fault')!r}: choose one of {', '.join(FAULTS)}")
    return event


def _tag(event: Any) -> str:
    if isinstance(event, Event):
        return _text(type(event))
    words = [word for word in _WORDS if word in event]
    return _text(FAULTS[event["fault"]] if words == [SENSOR] else KINDS[words[0]])


def _text(kind: type[Event]) -> str:
    """Tags in angle brackets do not show in messages."""
    return f"<{kind.__name__}>"


AnyEvent = Annotated[
    Annotated[PayloadEvent, Tag(_text(PayloadEvent))]
    | Annotated[ThrusterEvent, Tag(_text(ThrusterEvent))]
    | Annotated[SilentFault, Tag(_text(SilentFault))]
    | Annotated[ZerosFault, Tag(_text(ZerosFault))]
    | Annotated[StuckFault, Tag(_text(StuckFault))]
    | Annotated[BiasFault, Tag(_text(BiasFault))]
    | Annotated[NoiseFault, Tag(_text(NoiseFault))]
    | Annotated[OutlierFault, Tag(_text(OutlierFault))]
    | Annotated[LatencyFault, Tag(_text(LatencyFault))]
    | Annotated[ScaleFault, Tag(_text(ScaleFault))]
    | Annotated[WrenchEvent, Tag(_text(WrenchEvent))]
    | Annotated[JointEvent, Tag(_text(JointEvent))],
    Discriminator(_tag),
    BeforeValidator(_checked),
]
"""One event of any kind."""

Events = tuple[AnyEvent, ...]


class EventsConfig(Config):
    """The events of a run, for the plant."""

    events: Events = Field(
        (), description="what happens to the plant during the run: payload, faults, pushes"
    )


def event_from_text(text: str, now: int) -> Event:
    """One event of a YAML or JSON text; at `now`, ns, unless it says when.

    Raises:
        ConfigError: it is none; names the field and the choices.
    """
    data = parse_yaml(text, "event", ConfigError)
    if isinstance(data, Mapping):
        data = {"at_s": to_seconds(now), **data}
    config: EventsConfig = validated(EventsConfig, {"events": [data]}, "event")
    return config.events[0]


def check_events(events: Events, vehicle: Vehicle, step: int, period: int) -> None:
    """Check events against vehicle, plant step and control period (ns), before anything starts.

    Raises:
        ConfigError: a name that the vehicle does not have, a size that does not fit, a payload that
            is released without one, or an event that would be over before it has an effect.
    """
    for number, event in enumerate(events):
        try:
            event.check(vehicle)
            event.check_times(step, period)
        except ConfigError as fault:
            raise ConfigError(f"events.{number}: {fault}") from fault
    check_payloads(events)


def check_payloads(events: Iterable[Event], holds: bool = False) -> None:
    """Raise ConfigError where two payloads are held at once, or none is released.

    `holds`: whether the arm holds one before.
    """
    for event in sorted(events, key=lambda each: each.at_s):
        if isinstance(event, PayloadEvent):
            grasps = event.payload != RELEASE
            if grasps == holds:
                what = "holds a payload already; release it first" if holds else "holds none"
                raise ConfigError(f"payload at {event.at_s:g} s: the arm {what}")
            holds = grasps
