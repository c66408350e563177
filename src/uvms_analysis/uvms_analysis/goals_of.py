"""What became of each goal of a run, how well it was followed, and what navigation was worth."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError, determine
from uvms_core.signals import Array

NOTHING: dict[str, float | None] = {"rms": None, "max": None, "end": None}


def goals_of(run: Analysis) -> list[dict[str, Any]]:
    """The goals of a run in turn, as its end tells of them, with errors while each was active.

    `end_effector_error_m` is of the path, where the goal is one; `vehicle_error_m` the true vehicle
    against its reference; `navigation_error_m` and `navigation_std_m` the estimate's. Each has its
    root mean square, its greatest, and its last value.
    """
    end = run.log.end
    return [] if end is None else [_told(run, goal) for goal in end.goals]


def _told(run: Analysis, goal: Mapping[str, Any]) -> dict[str, Any]:
    told = dict(goal)
    if goal["began_s"] is None:
        return told
    begin = float(goal["began_s"])
    finish = np.inf if goal["ended_s"] is None else float(goal["ended_s"])
    figures: dict[str, Callable[[Analysis], tuple[Array, Array]]] = {
        "vehicle_error_m": lambda run: run.vehicle_error,
        "navigation_error_m": lambda run: run.navigation[:2],
        "navigation_std_m": lambda run: run.navigation[::2],
    }
    if goal["kind"] == "path" and run.target.kind == "path":
        figures["end_effector_error_m"] = _on_path
    for name, work in figures.items():
        try:
            time, values = determine(partial(work, run))
        except LogError:
            told[name] = NOTHING
        else:
            told[name] = _spread(values[(time >= begin) & (time <= finish)])
    return told


def _on_path(run: Analysis) -> tuple[Array, Array]:
    return run.truth.time[run.target.index], run.end_effector_error


def _spread(values: Array) -> dict[str, float | None]:
    if not len(values):
        return NOTHING
    lengths = np.linalg.norm(values, axis=1)
    rms = float(np.sqrt(np.mean(lengths**2)))
    return {"rms": rms, "max": float(lengths.max()), "end": float(lengths[-1])}
