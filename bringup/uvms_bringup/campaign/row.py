"""One row of results: a run's choice of values, its summary, and whether it kept its bounds."""

from collections.abc import Mapping
from typing import Any

from uvms_analysis.flat import flatten
from uvms_bringup.campaign.bound import faults
from uvms_bringup.campaign.plan import Run

Row = dict[str, Any]

RAISED = "error"
"""Outcome of a run that raised instead of ending."""

CHOSEN = "set."
"""Prefix of the columns with the values that were varied or drawn."""

OF_MACHINE = "error_of_machine"
"""Field that only rows have whose run was not made because of the machine; made again on resume."""

MISSING_LOG = "log_missing"
"""Field that only rows have whose log could not be written: why."""

TIMINGS = (
    "wall_s", "real_time_factor", "planner_step_ms.p50", "planner_step_ms.p99", MISSING_LOG,
)  # fmt: skip
"""Fields that depend on the machine; all others are the same wherever a run is made."""


def row_of(run: Run, summary: Mapping[str, Any]) -> Row:
    """The row of a run that has a summary."""
    flat = flatten({key: value for key, value in summary.items() if key not in _OF_A_FOLDER})
    return _row(run, flat, faults(run.required, flat))


def row_of_fault(run: Run, reason: str, of_machine: bool = False) -> Row:
    """The row of a run that raised."""
    mark = {OF_MACHINE: True} if of_machine else {}
    return _row(run, {"outcome": RAISED, "reasons": [reason], **mark}, [reason])


def is_failed(row: Mapping[str, Any]) -> bool:
    """Whether it counts and did not keep what is required; baselines do not count."""
    return not row["passed"] and not row["baseline_of"]


def without_timings(row: Mapping[str, Any]) -> Row:
    """What must be the same when a run is repeated."""
    return {key: value for key, value in row.items() if key not in TIMINGS}


_OF_A_FOLDER = ("run_id", "start_up_s", "seed")


def _row(run: Run, flat: Mapping[str, Any], failed: list[str]) -> Row:
    return {
        "case": run.case,
        "seed": run.seed,
        "baseline_of": run.baseline_of,
        "passed": not failed,
        "failed": failed,
        **{f"{CHOSEN}{path}": value for path, value in run.chosen.items()},
        **flat,
    }
