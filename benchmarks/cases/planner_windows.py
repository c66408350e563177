"""The next seconds planned anew at every step: time of a step, and what a payload costs."""

import time
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from metrics import Metric, Target
from whole_paths import problem_of

from uvms_core.signals import Array
from uvms_dynamics.payload import with_payload
from uvms_planner.whole_path import PathProblem, PathWindow, TimedPlan, solve
from uvms_planner.whole_path.change import Change
from uvms_planner.whole_path.plan import plan_values
from uvms_planner.whole_path.sample import WRENCHES
from uvms_planner.whole_path.window import acceptable

STEP_S = 0.5
CHANGED_S = 15.0
WEIGHTS_N = {"circle_xoz": 5.0, "line_ahead": 5.0, "paper_60": 5.0, "bluerov2_circle_xoz": 1.0}
"""Weight that the gripper then holds."""
KG_PER_N = 0.15
STEP = "the {step:g} s between two steps, one core"


def measure(full: bool) -> Iterator[Metric]:
    """Steps of windows along the paths, then the same paths with a payload from 15 s on."""
    for name in WEIGHTS_N if full else list(WEIGHTS_N)[::3]:
        problem = problem_of(name)
        whole = TimedPlan(0.0, solve(problem))
        _windows(problem, whole, 8)  # loads the kernels
        yield from _times(f"{name}_window", _windows(problem, whole, 120), 3.0, 10.0)
        yield from _changed(name, problem, whole)


def _times(name: str, seconds: Array, median: float, p99: float) -> Iterator[Metric]:
    for word, percent, bound in (("median", 50, median), ("p99", 99, p99)):
        value = 1e3 * float(np.percentile(seconds, percent))
        yield Metric(f"{name}_step_{word}", value, "ms", target=Target("value", "<=", bound))


def _windows(problem: PathProblem, whole: TimedPlan, most: int) -> Array:
    """Processor time of each step, the check of its limits included."""
    window = PathWindow(problem)
    last, in_hand, spent = None, whole, []
    for begin in STEP_S * np.arange(min(most, (problem.duration - window.duration) / STEP_S)):
        began = time.process_time()
        found = window.solve(begin, in_hand.state(begin), last, whole, in_hand)
        if acceptable(found, in_hand, begin):
            last = in_hand = found
        spent.append(time.process_time() - began)
    return np.array(spent[1:])  # the first has none before it


def _changed(name: str, problem: PathProblem, whole: TimedPlan) -> Iterator[Metric]:
    """J of what is left, against a plan of all of it from there; the longest step on the way."""
    weight = WEIGHTS_N[name]
    model = with_payload(problem.model, KG_PER_N * weight, weight, np.zeros(3))
    loaded, motion, spent, found = replace(problem, model=model), whole, [], 0.0
    change: Change | None = Change(loaded, CHANGED_S, whole)
    for begin in np.arange(CHANGED_S, problem.duration, STEP_S):
        if change is not None:
            began = time.process_time()
            motion = change.step(begin, motion.state(begin), motion)
            spent.append(time.process_time() - began)
            change = None if change.over else change
        found += _disturbance(loaded, motion, begin)
    start, left = whole.state(CHANGED_S), problem.duration - CHANGED_S
    again = solve(replace(loaded, tool=problem.tool.after(CHANGED_S), duration=left, start=start))
    best = again.report.disturbance
    yield Metric(f"{name}_payload_disturbance", found, "N^2 s", "the rest planned at once",
                 found / best, Target("ratio", "<=", 1.1))  # fmt: skip
    longest = max(spent)
    yield Metric(f"{name}_payload_longest_step", 1e3 * longest, "ms", STEP.format(step=STEP_S),
                 longest / STEP_S, Target("ratio", "<=", 0.5))  # fmt: skip
    yield Metric(f"{name}_payload_steps", float(len(spent)), "1", "until the new plan is followed")


def _disturbance(problem: PathProblem, motion: TimedPlan, begin: float) -> float:
    """J of one step."""
    times = begin + np.linspace(0.0, STEP_S, 26)
    posture = np.ascontiguousarray(motion.posture(times))
    values = plan_values(problem.model, problem.around, posture, problem.target(times))
    return float(np.trapezoid(np.sum(values[:, :WRENCHES] ** 2, axis=1), times))
