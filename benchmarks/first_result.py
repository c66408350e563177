"""The first result of a fresh process: `python first_result.py`.

Prints the clock readings, s, after each part: the caller has
read the time of the process's start on the same clock.
"""

import json
import time

began = time.monotonic()


def main() -> None:
    """Load the reference vehicle and compute its forward dynamics once, at rest."""
    readings = {"python": began}
    import numpy as np

    from uvms_core.vehicle import load_vehicle
    from uvms_dynamics import build_model, forward_dynamics

    readings["imports"] = time.monotonic()
    vehicle = load_vehicle()
    readings["vehicle"] = time.monotonic()
    model = build_model(vehicle)
    readings["model"] = time.monotonic()
    level, n = np.array([0.0, 0.0, 0.0, 1.0]), vehicle.n_joints
    found = forward_dynamics(model, level, np.zeros(6), np.zeros(n), np.zeros(n), np.zeros(6 + n))
    readings["forward_dynamics"] = time.monotonic()
    print(json.dumps({"readings": readings, "finite": bool(np.all(np.isfinite(found)))}))


if __name__ == "__main__":
    main()
