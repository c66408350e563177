"""Sensor models: rates, lever arms, noise and bias, one seed."""

from uvms_dynamics.simulation.sensors.suite import SensorFrame, SensorSuite

__all__ = ["SensorFrame", "SensorSuite"]
