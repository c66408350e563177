"""The planner methods on the same steps, and on whole short paths: quality, time, limits."""

import time
from collections.abc import Iterator

import numpy as np
from method_paths import PATHS, Followed, follow
from method_steps import OWN, PRINTED, Result, measured, states
from metrics import Metric

STEPWISE = ("paper", "genetic_steps", "sqp", "least_norm", "arm_only", "vehicle_only")
METHODS = ("genetic", *STEPWISE)
SEARCHES = ("paper", "genetic_steps", "sqp")
SMALL = {"paper": {"population": 20, "generations": 20}}
LARGE = {"paper": {"population": 400, "generations": 400}}
"""Of `paper` only the bits are printed: what more or less effort gives."""
BEST = "the least cost known on the path: SQP from 61 starts and all methods"


def measure(full: bool) -> Iterator[Metric]:
    """Steps with the cost as printed and with the planner's own, then the paths."""
    steps = states(1 if full else 12)
    clock = time.process_time  # of the processor: others may be at work
    for cost, fitness, methods in (("printed", PRINTED, SEARCHES), ("own", OWN, STEPWISE)):
        for name, result in measured(methods, fitness, steps, clock).items():
            yield from _of_steps(f"{name}_{cost}", result)
    for size, sections in (("small", SMALL), ("large", LARGE)):
        few = steps[:: 10 if size == "large" else 1]
        result = measured(("paper",), PRINTED, few, clock, **sections)["paper"]
        yield from _of_steps(f"paper_{size}_printed", result)
    for path, spec in PATHS.items():
        for name in METHODS:
            began = clock()
            followed = follow(name, spec)
            yield Metric(f"seconds_{name}_{path}", clock() - began, "s", "to plan and to follow it")
            yield from _of_path(f"{name}_{path}", followed)


def _of_steps(name: str, result: Result) -> Iterator[Metric]:
    reference = f"of {len(result.valid)} steps"
    yield Metric(f"valid_{name}", float(np.mean(result.valid)), "1", reference)
    seconds = np.array(result.seconds)
    yield Metric(f"step_median_{name}", 1e3 * float(np.median(seconds)), "ms")
    yield Metric(f"step_p99_{name}", 1e3 * float(np.percentile(seconds, 99)), "ms")
    yield Metric(f"evaluations_{name}", float(np.mean(result.evaluations)), "1")
    if result.gaps:
        yield Metric(f"gap_median_{name}", float(np.median(result.gaps)), "1", BEST)
        yield Metric(f"gap_p95_{name}", float(np.percentile(result.gaps, 95)), "1", BEST)
        yield Metric(f"excess_p95_{name}", float(np.percentile(result.excess, 95)), "N^2", BEST)


def _of_path(name: str, followed: Followed | None) -> Iterator[Metric]:
    yield Metric(f"accepted_{name}", float(followed is not None), "1", "the goal")
    if followed is None:
        return
    reference = "the whole path" if followed.finished else "as far as it came: given up"
    yield Metric(f"disturbance_{name}", followed.disturbance, "N^2 s", reference)
    yield Metric(f"worst_limit_{name}", followed.worst_ratio, "1", "rates and accelerations, 1 kHz")
    yield Metric(f"tool_error_{name}", 1e3 * followed.tool_error, "mm", "between the knots, 1 kHz")
    yield Metric(f"beyond_{name}", float(followed.steps_beyond), "1", "steps beyond accelerations")
