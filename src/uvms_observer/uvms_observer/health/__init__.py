"""Thruster health: which thruster gives less than it is told, seen in the vehicle's motion."""

from uvms_observer.health.handover import Handover
from uvms_observer.health.monitor import ThrusterMonitor

__all__ = ["Handover", "ThrusterMonitor"]
