"""Sensor models: rates, lever arms, noise and bias, one seed."""

from uvms_dynamics.sensors.suite import SensorFrame, SensorSuite

__all__ = ["SensorFrame", "SensorSuite"]
