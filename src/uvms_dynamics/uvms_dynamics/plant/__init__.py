"""The plant: the whole system over time, from a start that is checked to ground truth."""

from uvms_dynamics.plant.config import PlantConfig
from uvms_dynamics.plant.plant import Plant, SensorFrame
from uvms_dynamics.plant.truth import PlantTruth

__all__ = ["Plant", "PlantConfig", "PlantTruth", "SensorFrame"]
