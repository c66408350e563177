"""The vehicle file: schema, checks, keywords, loading and writing."""

from uvms_core.vehicle.arm import Arm, DragCylinder, Joint, Link
from uvms_core.vehicle.environment import Environment
from uvms_core.vehicle.hull import Attachment, Hull
from uvms_core.vehicle.limits import joint_limits
from uvms_core.vehicle.loader import (
    Examination,
    dump_vehicle,
    examine_vehicle,
    load_vehicle,
    vehicle_from_data,
    vehicle_from_yaml,
)
from uvms_core.vehicle.plausible import Finding, vehicle_findings, vehicle_warnings
from uvms_core.vehicle.sensors import Sensors
from uvms_core.vehicle.tether import Tether
from uvms_core.vehicle.thrusters import Thruster
from uvms_core.vehicle.vehicle import Vehicle

__all__ = [
    "Arm",
    "Attachment",
    "DragCylinder",
    "Environment",
    "Examination",
    "Finding",
    "Hull",
    "Joint",
    "Link",
    "Sensors",
    "Tether",
    "Thruster",
    "Vehicle",
    "dump_vehicle",
    "examine_vehicle",
    "joint_limits",
    "load_vehicle",
    "vehicle_findings",
    "vehicle_from_data",
    "vehicle_from_yaml",
    "vehicle_warnings",
]
