"""Compile every kernel once, so that the first run does not spend its time on that.

`python -m uvms_bringup.warm` runs each scenario for a few simulated seconds; numba keeps what it
compiled beside the sources.
"""

import sys

from uvms_bringup.scenario import known_scenarios, load_scenario
from uvms_bringup.simulate import simulate

WARM_S = 3.0


def main() -> int:
    """Run every scenario that comes with the project for a moment."""
    for name in known_scenarios():
        print(f"compiling kernels: {name}", file=sys.stderr, flush=True)
        scenario = load_scenario(name, duration_s=WARM_S)
        vehicle = scenario.load_vehicle()
        simulate(scenario, vehicle, scenario.goal.build(vehicle, scenario.plant))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
