"""Whether the navigation filter is as good as it says, over many seeds, and how far it drifts."""

from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from navigation_runs import VEHICLES, End, runs

from uvms_observer import NavigationConfig
from uvms_observer.navigation.trust.innovation_gate import quantile

SECONDS = 30.0
DRIFT = {"reference_auv": 0.0005, "bluerov2_alpha5": 0.003}
"""Greatest median drift without fixes, of the distance, by the class of the sensors."""


def measure(full: bool) -> Iterator[Metric]:
    """100 seeds of half a minute at half a metre a second with --full, else 20.

    NEES and NIS: mean over the seeds at the end, by degree of freedom; the ratio is 1 at the
    nearer bound of 95 %. The DVL is mounted as badly as the filter assumes for them, and as the
    vehicle file says for the drift.
    """
    seeds = 100 if full else 20
    assumed = NavigationConfig().noise_floor.misalignment_deg
    for name in VEHICLES:
        ends = list(runs(name, seeds, SECONDS, assumed))
        for part in ends[0].nees:
            yield _metric(f"{name}_nees_{part}", [(end.nees[part], 3) for end in ends])
        for sensor in ends[0].nis:
            yield _metric(f"{name}_nis_{sensor}", [end.nis[sensor] for end in ends])
        drift = float(np.median([end.drift for end in runs(name, seeds, SECONDS, 0.0)]))
        yield Metric(
            f"{name}_drift", 100.0 * drift, "%", f"of the distance; median of {seeds} seeds",
            drift / DRIFT[name], Target("ratio", "<=", 1.0),
        )  # fmt: skip


def _metric(name: str, squares: list[tuple[float, int]]) -> Metric:
    total, size = sum(square for square, _ in squares), sum(size for _, size in squares)
    low, high = quantile(size, 0.025), quantile(size, 0.975)
    off = (total - size) / ((high - size) if total > size else (size - low))
    reference = f"95 % bounds {low / size:.2f} to {high / size:.2f} for {size} degrees of freedom"
    return Metric(name, total / size, "", reference, abs(off), Target("ratio", "<=", 1.0))


__all__ = ["End", "measure"]
