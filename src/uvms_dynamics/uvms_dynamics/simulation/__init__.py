"""The simulated world: integrator, thrusters, sensors, plant. Never read by a node of the loop."""

from uvms_dynamics.simulation.integrator import System, make_state, make_system
from uvms_dynamics.simulation.plant import Plant, PlantConfig, PlantTruth, SensorFrame
from uvms_dynamics.simulation.simulate import advance_batch, simulate
from uvms_dynamics.simulation.thrusters import build_thrusters
from uvms_dynamics.simulation.water import CurrentConfig

__all__ = [
    "CurrentConfig",
    "Plant",
    "PlantConfig",
    "PlantTruth",
    "SensorFrame",
    "System",
    "advance_batch",
    "build_thrusters",
    "make_state",
    "make_system",
    "simulate",
]
