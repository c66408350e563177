"""What a step of the navigation filter costs, on time and with a DVL that comes late."""

import time
from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from navigation_runs import CRUISE, Rig

from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig, NavigationFilter

SECONDS, TICK_S, LATE_S, WARM = 60.0, 0.05, 0.2, 40
SIZE, PRODUCTS = 25, 40


def measure(full: bool) -> Iterator[Metric]:
    """Five inertial samples a step; the reference takes turns with it: products of matrices.

    The median over the steps on time; the mean over all with late samples, which come with some
    steps only.
    """
    on_time, reference = _timed(0.0)
    late, _ = _timed(LATE_S)
    median = float(np.median(on_time))
    yield Metric(
        "navigation_tick", 1e6 * median, "us",
        f"{PRODUCTS} products of {SIZE} x {SIZE} matrices by numpy", median / reference,
        Target("value", "<=", 120.0),
    )  # fmt: skip
    mean = float(np.mean(late))
    yield Metric(
        "navigation_tick_late", 1e6 * mean, "us", f"the same on time; DVL late by {LATE_S:g} s",
        mean / float(np.mean(on_time)), Target("ratio", "<=", 2.0),
    )  # fmt: skip


def _timed(delay_s: float) -> tuple[np.ndarray, float]:
    """Seconds of each step, and of the reference (the median)."""
    vehicle, waiting, delay = load_vehicle(), [], to_nanoseconds(delay_s)
    navigation = NavigationFilter(vehicle, NavigationConfig(initial_position_m=(0.0, 0.0, 10.0)))
    steps, others, matrix = [], [], np.eye(SIZE)
    for stamp, imu, dvl, pressure, gps in Rig(vehicle, CRUISE).frames(SECONDS, TICK_S):
        waiting += dvl
        due = [sample for sample in waiting if sample.stamp <= stamp - delay]
        waiting = waiting[len(due) :]
        began = time.perf_counter()
        navigation.step(stamp, imu, due, pressure, gps)
        between = time.perf_counter()
        for _ in range(PRODUCTS):
            matrix @ matrix
        steps.append(between - began)
        others.append(time.perf_counter() - between)
    return np.array(steps[WARM:]), float(np.median(others))
