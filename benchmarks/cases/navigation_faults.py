"""The navigation filter's faults: the worst of them on each vehicle, over seeds and motions."""

from collections.abc import Iterator

from metrics import Metric, Target
from navigation_runs import VEHICLES, fault_rows

from uvms_core.vehicle import load_vehicle


def measure(full: bool) -> Iterator[Metric]:
    """Three seeds and two motions with --full, else one; benchmarks/navigation_table.py has all."""
    motions = (None, "survey") if full else (None,)
    for name in VEHICLES:
        rows = list(fault_rows(load_vehicle(name), 3 if full else 1, motions))
        inside, jump = min(rows, key=lambda row: row.inside), max(rows, key=lambda row: row.jump)
        yield Metric(
            f"{name}_faults_inside", 100.0 * inside.inside, "%",
            f"of the ticks inside 3 sigma; the worst fault: {inside.name}", None,
            Target("value", ">=", 99.0),
        )  # fmt: skip
        yield Metric(
            f"{name}_faults_jump", jump.jump, "sigma",
            f"greatest jump of the output; the worst fault: {jump.name}", None,
            Target("value", "<=", 3.0),
        )  # fmt: skip
