"""One run of the manipulation in this process: `python graph.py simulate|composed|separate S DIR`.

Prints the real-time factor of the running phase, which `uvms run` and `uvms simulate` show while
they run: from WARM_S of simulated time, when all kernels are loaded, to the end.
"""

import json
import sys
import time

from uvms_bringup.pace import Pace
from uvms_bringup.progress import ProgressLine
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core.signals import to_seconds

WARM_S = 3.0


class Watch:
    """Replaces the progress line and records when simulated time passed."""

    began: tuple[float, float] | None = None
    ended: tuple[float, float] | None = None

    def __init__(self, end: int) -> None:
        pass

    def show(self, stamp: int, note: str) -> None:
        """Record simulated and wall time when simulated time has advanced."""
        now = to_seconds(stamp), time.monotonic()
        if now[0] >= WARM_S and Watch.began is None:
            Watch.began = now
        if Watch.ended is None or now[0] > Watch.ended[0]:
            Watch.ended = now

    def end(self) -> None:
        """Nothing to clean up."""


def main() -> int:
    """Run as the arguments say."""
    how, seconds, folder = sys.argv[1:]
    ProgressLine.show, ProgressLine.end = Watch(0).show, Watch(0).end  # type: ignore[method-assign]
    scenario = load_scenario("manipulation", duration_s=float(seconds))
    session = prepare(scenario, folder, "lockstep", "benchmark")
    if how == "simulate":
        summary = session.run_simulation()
    else:
        summary = session.run_graph(Pace.parse("lockstep"), how == "composed")
    if Watch.began is None or Watch.ended is None:
        return 1
    simulated, wall = (b - a for a, b in zip(Watch.began, Watch.ended, strict=True))
    summary["running_factor"] = simulated / wall
    print("\n" + json.dumps(summary))
    return 0 if summary["completed"] else 1


if __name__ == "__main__":
    raise SystemExit(main())
