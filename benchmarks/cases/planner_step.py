"""The genetic planner: candidates evaluated per second, and a whole step against its 0.5 s."""

import time
from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from planning import Planned, plan

REFERENCE = "the {step:g} s between two steps, one core"


def measure(full: bool) -> Iterator[Metric]:
    """Steps along the path of Fig. 9 while moving: the first minute."""
    planned: Planned = plan(
        "genetic_steps", seconds=300.0 if full else 60.0, clock=time.perf_counter
    )
    seconds = np.array(planned.step_seconds)
    evaluations = np.array(planned.evaluations)
    yield Metric("planner_evaluations", float(np.median(evaluations / seconds)), "1/s")
    yield Metric("planner_evaluations_per_step", float(np.mean(evaluations)), "1")
    for name, percent, bound in (("median", 50, 0.05), ("p99", 99, 0.1)):
        value = float(np.percentile(seconds, percent))
        yield Metric(
            f"planner_step_{name}", 1e3 * value, "ms", REFERENCE.format(step=planned.step_s),
            value / planned.step_s, Target("ratio", "<=", bound),
        )  # fmt: skip
