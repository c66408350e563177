"""Events: what happens to the plant during a run. Each kind is one file; `kinds` tells them apart.

{at_s: 20.0, payload: {mass_kg: 1.02, volume_m3: 0.0005}}
{at_s: 10.0, thruster: main, effectiveness: 0.0}
{at_s: 25.0, until_s: 40.0, sensor: dvl, fault: silent}
{at_s: 30.0, until_s: 32.0, wrench: {force_n: [10.0, 0.0, 0.0]}}
{at_s: 50.0, joint: elbow, stuck: true}
"""

from uvms_dynamics.simulation.events.event import Event
from uvms_dynamics.simulation.events.kinds import (
    Events,
    EventsConfig,
    check_events,
    event_from_text,
)
from uvms_dynamics.simulation.events.load import Load, loaded
from uvms_dynamics.simulation.events.schedule import Happened, Schedule, status_values

__all__ = [
    "Event",
    "Events",
    "EventsConfig",
    "Happened",
    "Load",
    "Schedule",
    "check_events",
    "event_from_text",
    "loaded",
    "status_values",
]
