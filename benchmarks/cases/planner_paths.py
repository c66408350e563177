"""Plans over whole paths: against a frozen arm and many starts; time, growth and limits."""

import time
from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from whole_paths import PATHS, best_of_starts, held, least_clearance, problem_of

from uvms_planner.whole_path import solve
from uvms_planner.whole_path.slower import slowed

STARTS = 8
UNIT = "N^2 s"
"""Of J: forces in N and moments in N m in one sum of squares."""


def measure(full: bool) -> Iterator[Metric]:
    """J = integral of |restoring|^2 + |coupling|^2 over each path, and what it takes to plan it."""
    solve(problem_of("paper_60"))  # loads the kernels
    for name in PATHS:
        yield from _of_path(name, 4 * STARTS if full else STARTS)
    yield _growth()


def _of_path(name: str, starts: int) -> Iterator[Metric]:
    problem = problem_of(name)
    began = time.perf_counter()
    plan = solve(problem)
    spent = time.perf_counter() - began
    found = plan.report.disturbance
    frozen, best = held(problem).report.disturbance, min(best_of_starts(problem, starts), found)
    yield Metric(f"{name}_disturbance", found, UNIT, f"best of {starts} starts", found / best,
                 Target("ratio", "<=", 1.1))  # fmt: skip
    yield Metric(f"{name}_against_frozen_arm", found, UNIT, "the arm frozen", found / frozen,
                 Target("ratio", "<=", 1.0))  # fmt: skip
    yield Metric(f"{name}_seconds", spent, "s", target=Target("value", "<=", 3.0))
    each_millisecond = np.linspace(0.0, plan.duration, round(1000 * plan.duration) + 1)
    worst = plan.report_at(each_millisecond).worst
    yield Metric(f"{name}_clearance", 1e3 * least_clearance(plan), "mm", "of arm and hull")
    yield Metric(f"{name}_share_of_limit", worst.share, "1", f"{worst.name}, at 1 kHz",
                 target=Target("value", "<=", 1.001))  # fmt: skip


def _growth() -> Metric:
    """Time to plan the paper's path in 3600 s, over that in 900 s."""
    short = problem_of("paper_900")
    seconds = [min(_seconds(each) for _ in range(3)) for each in (short, slowed(short, 4.0))]
    return Metric("paper_3600_seconds", seconds[1], "s", "the same in 900 s",
                  seconds[1] / seconds[0], Target("ratio", "<=", 4.4))  # fmt: skip


def _seconds(problem) -> float:
    began = time.perf_counter()
    solve(problem)
    return time.perf_counter() - began
