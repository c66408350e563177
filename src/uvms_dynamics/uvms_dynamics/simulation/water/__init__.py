"""Water that moves: currents, gusts and waves, by time and place."""

from uvms_dynamics.simulation.water.currents import CurrentConfig
from uvms_dynamics.simulation.water.tables import Water, build_water, velocity_at_start

__all__ = ["CurrentConfig", "Water", "build_water", "velocity_at_start"]
