"""Vehicle, kinematics, dynamics, thrusters, sensors and plant of the vehicle-manipulator system."""

from uvms_dynamics.model import Model, build_model
from uvms_dynamics.vehicle import Vehicle, dump_vehicle, load_vehicle

__all__ = ["Model", "Vehicle", "build_model", "dump_vehicle", "load_vehicle"]
