"""The state of a battery to its message and back; the message has 32-bit numbers."""

from collections.abc import Sequence
from math import isinf, nan
from typing import Any

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import BatteryState
from uvms_core.topic import Topic

DISCHARGING, UNKNOWN = 2, 0
"""POWER_SUPPLY_STATUS_DISCHARGING, and what stands for `unknown` in all three enumerations."""


def battery_to(topic: Topic, battery: BatteryState, names: Sequence[str]) -> Plain:
    """sensor_msgs/BatteryState; NaN and UNKNOWN for what the signal does not have."""
    return {
        "header": parts.header(topic, battery.stamp),
        "voltage": battery.voltage,
        "temperature": nan,
        "current": battery.current,
        "charge": battery.charge,
        "capacity": battery.capacity,
        "design_capacity": battery.capacity,
        "percentage": battery.percentage,
        "power_supply_status": DISCHARGING if battery.current < 0.0 else UNKNOWN,
        "power_supply_health": UNKNOWN,
        "power_supply_technology": UNKNOWN,
        "present": True,
        "cell_voltage": [],
        "cell_temperature": [],
        "location": "",
        "serial_number": "",
    }


def battery_from(topic: Topic, msg: Any, names: Sequence[str]) -> BatteryState:
    """From sensor_msgs/BatteryState, of whatever frame; only the voltage must be known."""
    return BatteryState(
        fields.stamp_of(msg.header.stamp),
        fields.number(topic, "voltage", msg.voltage),
        *(
            _number_or_nan(topic, name, getattr(msg, name))
            for name in ("current", "charge", "capacity", "percentage")
        ),
    )


def _number_or_nan(topic: Topic, path: str, value: float) -> float:
    if isinf(value):
        raise SignalError(f"{topic.name}: {path} is {value}; it must be finite, or NaN")
    return float(value)
