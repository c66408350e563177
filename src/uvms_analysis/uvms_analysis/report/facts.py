"""Figures of a run that its summary does not have: what it cost, how consistent its filter is."""

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from uvms_analysis import effort, navigation_check
from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError
from uvms_analysis.flat import flatten
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.summary import Figures, rms_and_max
from uvms_core import topics
from uvms_core.signals import Array

TRACKING = "end_effector_tracking_error_m"


class Facts:
    """All figures of a run by dotted name, the summary's included, and why some are missing."""

    def __init__(self, run: ReportedRun) -> None:
        self._run = run
        self.missing: dict[str, str] = dict(run.summary.get("missing") or {})

    @cached_property
    def values(self) -> Mapping[str, Any]:
        """Figures by dotted name; None where the log does not determine one."""
        figures = Figures(self._run.log)
        found = {name: figures.of(name, work) for name, work in self._works().items()}
        self.missing |= figures.missing
        values = flatten(self._run.summary) | flatten(found)
        if values.get(f"{TRACKING}.rms") is None and (seen := found["tracking_seen_m"]):
            # The summary measures it where the truth says where the tool should be.
            values |= {f"{TRACKING}.{key}": value for key, value in seen.items()}
            self.missing.pop(TRACKING, None)
        return values

    def why_not(self, name: str) -> str:
        """Why a figure is missing; empty where nobody says."""
        parts = name.split(".")
        known = (".".join(parts[:count]) for count in range(len(parts), 0, -1))
        return next((self.missing[each] for each in known if each in self.missing), "")

    def _works(self) -> dict[str, Callable[[], Any]]:
        run, truth, seen = self._run, self._run.truth, self._run.seen
        return {
            "tracking_seen_m": lambda: rms_and_max(seen.end_effector_error),
            "joint_error_deg": lambda: rms_and_max(
                np.abs(truth.joint_error_deg[1]).max(axis=1, initial=0.0)
            ),
            "navigation_within": lambda: navigation_check.share_within(truth),
            "navigation_nees": lambda: float(np.mean(navigation_check.normalized_error(truth)[1])),
            "yaw_error_deg": lambda: rms_and_max(
                navigation_check.attitude_error_deg(truth)[1][:, 2]
            ),
            "external": lambda: _halves(truth.disturbance.external),
            "external_observed": lambda: _halves(truth.observed.external),
            "authority_left": lambda: float(np.min(effort.authority_left(truth))),
            "thrust_total_n": lambda: float(np.mean(effort.total_thrust(truth))),
            "impulse_ns": lambda: effort.integral(
                truth.allocation.time, effort.total_thrust(truth)
            ),
            "thruster_work_j": lambda: _work(effort.thruster_power(_best(run))),
            "arm_work_j": lambda: _work(effort.arm_power(truth)),
            "torque_share": lambda: float(np.max(effort.torque_shares(truth)[1])),
            "safe_ticks": lambda: _safe_ticks(truth),
            "command_age_s": lambda: _oldest(truth),
        }


def _best(run: ReportedRun) -> Analysis:
    """By the truth, or by the estimate where there is none."""
    return run.truth if run.log.has(topics.TRUE_ODOMETRY) else run.seen


def _halves(wrenches: Array) -> dict[str, float | None]:
    """Root mean square and greatest of forces and moments, without the first sample."""
    force, moment = rms_and_max(wrenches[1:, :3]), rms_and_max(wrenches[1:, 3:])
    return {"force_rms_n": force["rms"], "force_max_n": force["max"],
            "moment_rms_nm": moment["rms"], "moment_max_nm": moment["max"]}  # fmt: skip


def _work(power: tuple[Array, Array]) -> float:
    """Mechanical work, J: what was given and what was braked both count."""
    time, values = power
    return effort.integral(time, np.abs(values))


def _safe_ticks(run: Analysis) -> int:
    return int(np.isnan(effort.command_age(run)[1]).sum())


def _oldest(run: Analysis) -> float:
    ages = effort.command_age(run)[1]
    if np.isnan(ages).all():
        raise LogError("the plant never used a command")
    return float(np.nanmax(ages))
