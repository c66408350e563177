"""Eq. (18) as printed over the path of Fig. 9: by the method paper, genetic and sqp."""

from collections.abc import Iterator

import numpy as np
from metrics import Metric
from planning import plan, self_disturbance

from uvms_bringup.scenario import load_scenario

PRINTED = tuple(
    f"planner.fitness.{word}"
    for word in (
        "combined=true",
        "lookahead_s=0",
        "smoothness_weight=0",
        "vehicle_motion_weight=0",
        "joint_motion_weight=0",
    )
)
REPORTED = ("planner.limits.strict=false",)
"""Steps beyond the accelerations are taken, as none of the three gets through without."""
ROWS = {"paper": (), "genetic_steps": PRINTED, "sqp": PRINTED}
DETERMINISTIC = ("sqp",)
SEEDS = 5
UNITS = {"force": "N", "moment": "N m", "acceleration": "deg/s^2", "beyond": "1"}


def measure(full: bool) -> Iterator[Metric]:
    """Median, least and greatest over the seeds of the figures of a plan.

    Root mean squares of force and moment and the greatest joint acceleration of the references'
    samples, and the steps beyond the accelerations.
    """
    seconds = load_scenario("manipulation").goal.path.duration_s if full else 60.0
    for method, settings in ROWS.items():
        seeds = range(1, 2 if method in DETERMINISTIC or not full else SEEDS + 1)
        found = [_figures(method, seconds, (*settings, *REPORTED, f"seed={s}")) for s in seeds]
        reference = f"the first {seconds:g} s, seeds {seeds[0]} to {seeds[-1]}"
        for part, unit in UNITS.items():
            values = [figures[part] for figures in found]
            for word, of in (("", np.median), ("_least", np.min), ("_greatest", np.max)):
                yield Metric(f"printed_{part}_{method}{word}", float(of(values)), unit, reference)


def _figures(method: str, seconds: float, settings: tuple[str, ...]) -> dict[str, float]:
    planned = plan(method, seconds, settings=settings)
    wrenches = self_disturbance(planned.references)
    return {
        "force": float(np.sqrt(np.mean(np.sum(wrenches[:, :3] ** 2, axis=1)))),
        "moment": float(np.sqrt(np.mean(np.sum(wrenches[:, 3:] ** 2, axis=1)))),
        "acceleration": float(
            np.rad2deg(max(np.max(np.abs(r.q_ddot)) for r in planned.references))
        ),
        "beyond": float(planned.beyond),
    }
