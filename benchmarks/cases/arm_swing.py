"""Roll while the arm swings out: with the observer, without it (Fig. 8), uncontrolled (Fig. 7)."""

from collections.abc import Iterator

import numpy as np
from closed_loop import Run, run
from metrics import Metric, Target

from uvms_bringup.scenario import load_scenario


def measure(full: bool) -> Iterator[Metric]:
    """The whole scenario `arm_swing`, three times."""
    found = _roll(run(load_scenario("arm_swing")))
    without = _roll(run(load_scenario("arm_swing", ["control.observer=false"])))
    free = _roll(run(load_scenario("arm_swing", ["control.enabled=false"])))
    yield Metric(
        "arm_swing_roll_max", found, "deg", "the same without the observer", found / without,
        Target("ratio", "<=", 0.5),
    )  # fmt: skip
    yield Metric(
        "arm_swing_roll_max_without_observer", without, "deg", "the same without vehicle control",
        without / free,
    )  # fmt: skip
    yield Metric("arm_swing_roll_max_uncontrolled", free, "deg")


def _roll(found: Run) -> float:
    return float(np.max(np.abs(found.rpy_deg[:, 0])))
