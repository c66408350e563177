"""Plots of what acts on the vehicle besides its thrusters: parts, plan against truth, observed."""

from collections.abc import Callable
from functools import partial

import numpy as np

from uvms_analysis.log.read import Series
from uvms_analysis.report.plot import Curve, Panel, Part, panel, panels
from uvms_analysis.report.run import ReportedRun
from uvms_core.signals import Array

PARTS = ("restoring", "coupling", "external")
HALVES = (("force", "N", slice(0, 3)), ("moment", "N m", slice(3, 6)))
COMPONENTS = (("X", "N"), ("Y", "N"), ("Z", "N"), ("K", "N m"), ("M", "N m"), ("N", "N m"))
LEAST = 0.05
"""Span of an axis of N or N m at the least."""


def budget(run: ReportedRun) -> list[Panel]:
    """Lengths of restoring, coupling and external force and moment, true and as observed."""

    def length(part: str, half: slice, series: Callable[[], Series]) -> Curve:
        found = _after_start(series())
        return found.time, np.linalg.norm(getattr(found, part)[:, half], axis=1)

    return panels([
        partial(panel, f"budget_{part}_{kind}", f"{part} {kind}", unit,
                _true_and_observed(run, partial(length, part, half)), least=LEAST, peaks=True)
        for kind, unit, half in HALVES for part in PARTS
    ])  # fmt: skip


def _after_start(series: Series) -> Series:
    """Without the first sample, at which no joint torque is applied and the arm starts to fall."""
    return series.take(np.arange(1, len(series)))


def _true_and_observed(
    run: ReportedRun, work: Callable[[Callable[[], Series]], Curve]
) -> list[Part]:
    return [
        Part("true", lambda: work(lambda: run.truth.disturbance)),
        Part("observed", lambda: work(lambda: run.truth.observed), "thin"),
    ]


def plan_against_truth(run: ReportedRun) -> list[Panel]:
    """The self-disturbance (restoring plus coupling) that was planned, that came, and the rest."""

    def total(series: Series) -> Array:
        return np.asarray(series.restoring + series.coupling)

    def came(axis: int, series: Callable[[], Series]) -> Curve:
        found = _after_start(series())
        return found.time, total(found)[:, axis]

    def planned(axis: int) -> Curve:
        plan = run.truth.planned_disturbance
        return plan.time, total(plan)[:, axis]

    return panels([
        partial(panel, f"self_{name}", f"self-disturbance {name}", unit,
                [*_true_and_observed(run, partial(came, axis)),
                 Part("planned", partial(planned, axis), "dash")], least=LEAST, peaks=True)
        for axis, (name, unit) in enumerate(COMPONENTS)
    ])  # fmt: skip


def external(run: ReportedRun) -> list[Panel]:
    """The external wrench by component, with three standard deviations of the observed one."""

    def value(axis: int, series: Callable[[], Series]) -> Curve:
        found = _after_start(series())
        return found.time, found.external[:, axis]

    def edge(axis: int, sign: float) -> Curve:
        found = _after_start(run.truth.observed)
        three = 3.0 * found.external_sigma[:, axis]
        # Zero means that the observer does not say how sure it is.
        return found.time, np.where(three > 0.0, found.external[:, axis] + sign * three, np.nan)

    return panels([
        partial(panel, f"external_{name}", f"external {name}", unit,
                [*_true_and_observed(run, partial(value, axis)),
                 Part("observed ± 3 σ", partial(edge, axis, 1.0), "high"),
                 Part("observed ± 3 σ", partial(edge, axis, -1.0), "low")],
                least=LEAST, peaks=True)
        for axis, (name, unit) in enumerate(COMPONENTS)
    ])  # fmt: skip
