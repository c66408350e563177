"""A glance as one plain line, for files, pipes and terminals without colours."""

from uvms_bringup.terminal.glance import Bounded, Glance, Measured
from uvms_bringup.terminal.words import (
    EXCEEDED,
    NOTHING,
    battery_text,
    pace_text,
    time_text,
    value_text,
)

GAP = "  "


def line(glance: Glance) -> str:
    """Time, pace, phase, tool, roll, pitch, battery, thrusters at their limits, health."""
    own = glance.measured
    parts = [
        f"{time_text(glance):>14}",
        pace_text(glance),
        glance.phase or NOTHING,
        f"tool {_value(own.tool)}",
        f"roll {_value(own.roll)}",
        f"pitch {_value(own.pitch)}",
        *_battery(own),
        *_saturated(own),
        f"health {NOTHING if own.health is None else own.health.words}",
    ]
    return " ".join(GAP.join(parts).splitlines())


def _value(bounded: Bounded) -> str:
    return value_text(bounded) + EXCEEDED * bounded.is_exceeded


def _battery(measured: Measured) -> list[str]:
    return [] if measured.battery is None else [f"battery {battery_text(measured.battery)}"]


def _saturated(measured: Measured) -> list[str]:
    names = [each.name for each in measured.thrusters if each.is_saturated]
    return [f"at its limit: {', '.join(names)}"] if names else []
