"""Campaigns: runs a second on one and two workers, overhead against a bare loop, memory."""

import os
import statistics
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from metrics import Metric, Target

from uvms_bringup.campaign.cluster import Cluster
from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.plan import Run, runs, variants
from uvms_bringup.campaign.worker import make_row
from uvms_bringup.simulate import simulate

RUNS, FULL_RUNS = 6, 24
"""Runs of a minute for the rates; shortened, and whole."""
PAIRS = 5
"""Runs for the overhead; the median of their ratios counts."""
SHORT_RUNS, FULL_SHORT_RUNS, SHORT_S = 100, 500, 1.0
"""Runs for the memory of a worker, and how long they are, s."""
SETTLED = 0.2
"""Share of these runs after which a worker has loaded all that it needs."""


def measure(full: bool) -> Iterator[Metric]:
    """Rates by wall time, from the first to the last row; overhead by processor time."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        count = FULL_RUNS if full else RUNS
        one, two = (_rate(_runs(folder, count, 60.0), folder, n) for n in (1, 2))
        yield Metric("campaign_one_worker", one, "runs/s", "runs of 60 s, hover")
        yield Metric(
            "campaign_two_workers", two, "runs/s", "one worker", two / one,
            Target("ratio", ">=", 1.8),
        )  # fmt: skip
        yield _overhead(_runs(folder, PAIRS, 60.0), folder)
        yield _growth(_runs(folder, FULL_SHORT_RUNS if full else SHORT_RUNS, SHORT_S), folder)


def _runs(folder: Path, count: int, duration_s: float) -> list[Run]:
    file = folder / "campaign.yaml"
    file.write_text(f"scenario: hover\nseeds: {count}\nset: {{duration_s: {duration_s}}}\n")
    return list(runs(variants(load_campaign(str(file)))))


def _rate(made: list[Run], folder: Path, workers: int) -> float:
    """Runs per second once all workers are busy: those that end first are not counted."""
    with Cluster(workers) as cluster:
        ends = []
        for row in cluster.rows(iter(made), folder, "none", lambda: None):
            if row["outcome"] != "completed":
                raise ArithmeticError(f"a run was {row['outcome']}: {row['reasons']}")
            ends.append(time.monotonic())
    return (len(ends) - workers) / (ends[-1] - ends[workers - 1])


def _overhead(made: list[Run], folder: Path) -> Metric:
    """A row of a campaign over the same scenario loaded and simulated with nothing kept."""

    def bare(run: Run) -> None:
        scenario = run.load()
        vehicle = scenario.load_vehicle()
        own = scenario.for_vehicle(vehicle)
        simulate(own, vehicle, own.goal.build(vehicle, own.plant))

    make_row(made[0], folder, "none")  # compiles, and fills caches
    ratios, spent = [], []
    for run in made:
        began = time.process_time()
        make_row(run, folder, "none")
        middle = time.process_time()
        bare(run)
        spent.append(middle - began)
        ratios.append(spent[-1] / (time.process_time() - middle))
    return Metric(
        "campaign_run", statistics.median(spent), "s", "a bare loop", statistics.median(ratios),
        Target("ratio", "<=", 1.10),
    )  # fmt: skip


def _growth(made: list[Run], folder: Path) -> Metric:
    """Memory of a worker at the end over that when it had settled, and what it grew by."""
    with Cluster(1) as cluster:
        done, settled = 0, 0.0
        for row in cluster.rows(iter(made), folder, "none", lambda: None):
            if row["outcome"] == "error":
                raise ArithmeticError(row["reasons"][0])
            done += 1
            if done == int(SETTLED * len(made)):
                settled = _size_mb(cluster)
        last = _size_mb(cluster)
    return Metric(
        f"campaign_memory_after_{len(made)}_runs", last, "MB", "after a fifth of them",
        last / settled, Target("ratio", "<=", 1.05),
    )  # fmt: skip


def _size_mb(cluster: Cluster) -> float:
    (size,) = cluster.call(_resident_mb).values()
    return size


def _resident_mb() -> float:
    """Resident memory of this process, MB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6
