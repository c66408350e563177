"""Self-disturbance planned over the path of Fig. 9: genetic against arm_only and least_norm."""

from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from planning import plan, self_disturbance

from uvms_bringup.scenario import load_scenario

OTHERS = {"arm_only": 0.5, "least_norm": 1.0}
PARTS = {"cost": (slice(0, 6), "rms"), "force": (slice(0, 3), "N"), "moment": (slice(3, 6), "N m")}
JUDGED = ("cost", "moment")
"""Parts with a target. Vehicle and arm are neutrally buoyant, so that the planned force is a few
thousandths of a newton for every method: reported, but negligible."""


def measure(full: bool) -> Iterator[Metric]:
    """Restoring plus coupling wrench at the reference's samples, root mean square of its length.

    `cost` is the paper's, eq. (18): forces in N and moments in N m in one sum of squares.
    """
    path = load_scenario("manipulation").goal.path
    found = {method: _rms(method, path.duration_s) for method in ("genetic", *OTHERS)}
    for other, bound in OTHERS.items():
        for part, (_, unit) in PARTS.items():
            value = found["genetic"][part]
            yield Metric(
                f"planned_{part}_against_{other}", value, unit, f"the same path by {other}",
                value / found[other][part],
                Target("ratio", "<=", bound) if part in JUDGED else None,
            )  # fmt: skip


def _rms(method: str, seconds: float) -> dict[str, float]:
    planned = plan(method, seconds)
    if planned.success is not True:
        raise ArithmeticError(f"{method} did not reach the end of the path")
    wrenches = self_disturbance(planned.references)
    return {
        part: float(np.sqrt(np.mean(np.sum(wrenches[:, axes] ** 2, axis=1))))
        for part, (axes, _) in PARTS.items()
    }
