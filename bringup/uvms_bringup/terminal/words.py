"""The values of a glance as text with their units, the same in the panel and in the lines."""

from uvms_bringup.campaign.progress import clock
from uvms_bringup.terminal.glance import Battery, Bounded, Glance, Push, Thruster
from uvms_core.battery import LOW

NOTHING = "-"
"""In the place of a value that has not come."""
EXCEEDED = "!"
"""Follows a value that is beyond its limit, for terminals and eyes without colours."""


def time_text(glance: Glance) -> str:
    """Simulated time and how long the run is, s."""
    return f"{glance.time:.1f} of {glance.end:.10g} s"


def pace_text(glance: Glance) -> str:
    """Pace in times real time."""
    return NOTHING if glance.pace is None else f"{glance.pace:.1f}x real time"


def left_text(glance: Glance) -> str:
    """Wall time that is left, in hours, minutes and seconds."""
    return NOTHING if glance.left_s is None else f"{clock(glance.left_s)} left"


def bounded_text(bounded: Bounded) -> str:
    """Value with its unit, and its limit."""
    if bounded.value is None:
        return f"{NOTHING} (limit {bounded.limit:g} {bounded.unit})"
    mark = f" {EXCEEDED}" if bounded.is_exceeded else ""
    return f"{value_text(bounded)} (limit {bounded.limit:g}){mark}"


def value_text(bounded: Bounded) -> str:
    """Value with its unit alone; none is -0.00."""
    if bounded.value is None:
        return NOTHING
    return f"{round(bounded.value, 2) + 0.0:.2f} {bounded.unit}"


def push_text(push: Push | None) -> str:
    """Force and moment."""
    return NOTHING if push is None else f"{push.force:.2f} N, {push.moment:.2f} N m"


def battery_text(battery: Battery) -> str:
    """Share of the charge, voltage and power, marked where it is low."""
    mark = f" {EXCEEDED}" if battery.share < LOW else ""
    share = NOTHING if battery.share != battery.share else f"{battery.share:.1%}"
    power = NOTHING if battery.power != battery.power else f"{battery.power + 0.0:.0f} W"
    return f"{share}, {battery.voltage:.1f} V, {power}{mark}"


def thrust_text(thruster: Thruster) -> str:
    """Thrust with its unit, marked where it is saturated."""
    if thruster.thrust is None:
        return f"{NOTHING:>6}  "
    return f"{round(thruster.thrust, 1) + 0.0:+6.1f} N{EXCEEDED if thruster.is_saturated else ' '}"
