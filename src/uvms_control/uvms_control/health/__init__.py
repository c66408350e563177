"""Thruster health on the allocator's side: what is believed, what remains, what is told."""

from uvms_control.health.authority import lost_axes, remaining_authority
from uvms_control.health.belief import ThrusterBelief
from uvms_control.health.thrusters import Thrusters

__all__ = ["ThrusterBelief", "Thrusters", "lost_axes", "remaining_authority"]
