"""What the simulation asks of a model of a sensor."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from uvms_core.rng import generator
from uvms_core.sensors import SensorType
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.sensors.mounting import Trajectory


class SensorModel(ABC):
    """One sensor on the vehicle; found by its name in the entry points `uvms.sensors`.

    A subclass gives `type`, and extends `__init__` where it takes more from the vehicle file. Its
    random numbers all come from `self.rng`, so that no sensor shifts another's.

    Args:
        vehicle: whose sensor it is; the water around it.
        section: the sensor's own section of the vehicle file, of class `type.section`.
        period: between two samples, ns.
        seed: of the run.
    """

    type: ClassVar[SensorType]

    def __init__(self, vehicle: Vehicle, section: Any, period: int, seed: int) -> None:
        self.period = period
        self.rng = generator(seed, f"sensors/{self.type.name}")

    @abstractmethod
    def sample(self, trajectory: Trajectory) -> tuple[Any, ...]:
        """Samples that are due on the trajectory, in order: of class `type.signal`."""
