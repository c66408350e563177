"""The two frames of the world: `map_ned`, in which everything is computed, and REP-105's `map`."""

import numpy as np

MAP_FRAME = "map"
"""REP-105: east, north, up; origin as `map_ned`."""
R_MAP_MAP_NED = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
"""Components in map_ned to those in map; its own inverse."""
R_MAP_MAP_NED.flags.writeable = False
