"""The vehicle file: schema, checks, shorthand words, loading and writing."""

from uvms_dynamics.vehicle.arm import Arm, DragCylinder, Joint, Link
from uvms_dynamics.vehicle.environment import Environment
from uvms_dynamics.vehicle.hull import Attachment, Hull
from uvms_dynamics.vehicle.loader import (
    dump_vehicle,
    load_vehicle,
    vehicle_from_data,
    vehicle_from_yaml,
)
from uvms_dynamics.vehicle.sensors import Sensors
from uvms_dynamics.vehicle.tether import Tether
from uvms_dynamics.vehicle.thrusters import Thruster
from uvms_dynamics.vehicle.vehicle import Vehicle

__all__ = [
    "Arm",
    "Attachment",
    "DragCylinder",
    "Environment",
    "Hull",
    "Joint",
    "Link",
    "Sensors",
    "Tether",
    "Thruster",
    "Vehicle",
    "dump_vehicle",
    "load_vehicle",
    "vehicle_from_data",
    "vehicle_from_yaml",
]
