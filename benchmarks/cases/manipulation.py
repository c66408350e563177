"""The manipulation of Fig. 9 in closed loop: errors of end effector and navigation, attitude."""

from collections.abc import Iterator

import numpy as np
from closed_loop import Run, rms, run
from metrics import Metric, Target

from uvms_bringup.scenario import Scenario, load_scenario

SHORT_S, SHARE = 40.0, 0.3
"""Shortened: seconds of each phase, and the size of the path; twice the speed of the whole one."""


def measure(full: bool) -> Iterator[Metric]:
    """Shortened unless `full`; then once more without the observer's feed-forward."""
    name = "manipulation" if full else "manipulation_short"
    with_observer, without = run(_scenario(full)), run(_scenario(full, "control.observer=false"))
    for found in (with_observer, without):
        if not found.completed:
            raise ArithmeticError("the run did not complete")
    yield from _errors(name, with_observer, without)
    for axis, angle, bound in ((0, "roll", 5.0), (1, "pitch", 4.0)):
        yield Metric(
            f"{name}_{angle}_max", float(np.max(np.abs(with_observer.rpy_deg[:, axis]))), "deg",
            target=Target("value", "<=", bound),
        )  # fmt: skip


def _errors(name: str, found: Run, without: Run) -> Iterator[Metric]:
    reference = "the same without the observer"
    true = rms(found.true_error)
    yield Metric(
        f"{name}_end_effector_error", true, "m rms", reference, true / rms(without.true_error),
        Target("value", "<=", 0.05),
    )  # fmt: skip
    seen = rms(found.seen_error)
    yield Metric(
        f"{name}_end_effector_error_seen", seen, "m rms", reference, seen / rms(without.seen_error)
    )
    yield Metric(f"{name}_navigation_error", rms(found.navigation_error), "m rms")


def _scenario(full: bool, *settings: str) -> Scenario:
    scenario = load_scenario("manipulation", settings)
    if full:
        return scenario
    path = scenario.goal.path
    phases = tuple(
        phase.model_copy(
            update={
                "duration_s": SHORT_S,
                "to_m": tuple(SHARE * x for x in phase.to_m),
                "bulge_m": tuple(SHARE * x for x in phase.bulge_m),
            }
        )
        for phase in path.phases
    )
    goal = scenario.goal.model_copy(update={"path": path.model_copy(update={"phases": phases})})
    duration = SHORT_S * len(phases) + 2.0
    return scenario.model_copy(update={"goal": goal, "duration_s": duration})
