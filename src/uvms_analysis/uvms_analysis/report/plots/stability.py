"""Plots of the controller's own account of its stability, by eq. (27) to (29)."""

from functools import partial

import numpy as np

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import Series
from uvms_analysis.report.plot import Curve, Limit, Panel, Part, panel, panels
from uvms_analysis.report.run import ReportedRun

LEAST = 1e-9
"""V below this is drawn as this: the errors are then below 0.05 mm and 0.05 mrad."""


def stability(run: ReportedRun) -> list[Panel]:
    """V, its rate by the model and as it happens, and both sides of the condition below (29)."""
    found: Series = run.truth.stability
    if len(found.time) < 2:
        raise LogError(f"log {run.log.path}: has a single {found.name}")

    def of(values: np.ndarray) -> Curve:
        return found.time, values

    value = Part("V", partial(of, np.maximum(found.lyapunov, LEAST)))
    rates = [
        Part("by the model", partial(of, found.lyapunov_rate)),
        Part("as it happens", partial(of, np.gradient(found.lyapunov, found.time)), "thin"),
    ]
    sides = [
        Part("supply", partial(of, found.supply)),
        Part("demand", partial(of, found.demand)),
    ]
    zero = [Limit("zero", 0.0)]
    return panels([
        partial(panel, "lyapunov", "Lyapunov function V of (27)", "m²/s², rad²/s²", [value],
                is_log=True),
        partial(panel, "lyapunov_rate", "rate of V", "m²/s³, rad²/s³", rates, zero, least=1e-9,
                peaks=True),
        partial(panel, "condition", "condition below (29): supply must not be below demand", "W",
                sides, zero, least=1e-6, peaks=True),
    ])  # fmt: skip
