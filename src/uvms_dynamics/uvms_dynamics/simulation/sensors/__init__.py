"""Models of sensors: rates, lever arms, noise and bias, one seed."""

from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import Trajectory
from uvms_dynamics.simulation.sensors.suite import SensorFrame, SensorSuite

__all__ = ["SensorFrame", "SensorModel", "SensorSuite", "Trajectory"]
