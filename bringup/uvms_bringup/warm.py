"""Compile every kernel once, so that the first run does not spend its time on that.

`python -m uvms_bringup.warm` runs each scenario for a few simulated seconds; numba keeps what it
compiled beside the sources. It prints what is being compiled: on a terminal in one line, elsewhere
in a line for each kernel. How many there will be is not known beforehand, only how many there are.
"""

import sys
import threading
import time

import numpy as np

from uvms_bringup.scenario import known_scenarios, load_scenario
from uvms_bringup.simulate import simulate
from uvms_core.vehicle import Vehicle
from uvms_dynamics.geometry import build_geometry, clearances_of_poses
from uvms_dynamics.kernels.jit import kernel_names
from uvms_dynamics.kernels.numba_internals.compilations import reported

WARM_S = 3.0
WITHOUT_WAVES = ("swell", "plant.current.waves=[]")
"""Water that moves without waves has kernels of its own, and no scenario of its own."""
BY_WEIGHTS = ("hover", "allocation=weighted_least_squares")
"""So has allocation by weights."""
DEAD_ZONES = "vehicle=bluerov2_alpha5"
"""Its thrusters have dead zones, which take a kernel for either allocation."""


class ProgressLine:
    """Counts kernels as numba begins to compile them, and shows the one that it is at."""

    def __init__(self) -> None:
        self._live = sys.stdout.isatty()
        self._begun = time.monotonic()
        self._all = kernel_names()
        self._seen: set[tuple[str, str]] = set()
        self._text = "starting"
        self._ended = threading.Event()
        self._ticker = threading.Thread(target=self._tick, daemon=True)

    def __enter__(self) -> "ProgressLine":
        self._ticker.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._ticker.join()
        clear = "\r\x1b[K" if self._live else ""
        print(f"{clear}{len(self._seen)} kernels compiled in {self._seconds():.0f} s", flush=True)

    def kernel(self, module: str, name: str) -> None:
        """A function that numba begins to compile; what is no kernel of the project is a part."""
        key = (module, name)
        if key not in self._all or key in self._seen:
            return
        self._seen.add(key)
        self._text = f"kernel {len(self._seen)} of at most {len(self._all)}: {name}"
        if not self._live:
            print(f"{self._text} ({self._seconds():.0f} s)", flush=True)

    def _seconds(self) -> float:
        return time.monotonic() - self._begun

    def _tick(self) -> None:
        while self._live and not self._ended.wait(0.25):
            print(f"\r\x1b[K{self._text} ({self._seconds():.0f} s)", end="", flush=True)


def main() -> int:
    """Run every scenario that comes with the project for a moment."""
    with ProgressLine() as line, reported(line.kernel):
        for name, *settings in (
            *([name] for name in known_scenarios()),
            WITHOUT_WAVES,
            (*BY_WEIGHTS, DEAD_ZONES),
            ("hover", DEAD_ZONES),
        ):
            scenario = load_scenario(name, settings, duration_s=WARM_S)
            vehicle = scenario.load_vehicle()
            simulate(scenario, vehicle, scenario.build_goals(vehicle))
        _clearances_of_a_log(vehicle)
    return 0


def _clearances_of_a_log(vehicle: Vehicle) -> None:
    """The kernel of the summary, in which no simulation has a part."""
    level = np.array([[0.0, 0.0, 0.0, 1.0]])
    angles = np.zeros((1, vehicle.n_joints))
    clearances_of_poses(build_geometry(vehicle), np.zeros((1, 3)), level, angles)


if __name__ == "__main__":
    raise SystemExit(main())
