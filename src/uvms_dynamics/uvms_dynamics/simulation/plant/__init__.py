"""The plant: the whole system over time, from a start that is checked to ground truth."""

from uvms_dynamics.simulation.plant.config import PlantConfig
from uvms_dynamics.simulation.plant.plant import Plant, SensorFrame
from uvms_dynamics.simulation.plant.truth import PlantTruth

__all__ = ["Plant", "PlantConfig", "PlantTruth", "SensorFrame"]
