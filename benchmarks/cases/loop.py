"""One tick of the whole loop in process, part by part, along the manipulation and at hover."""

import time
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from metrics import Metric, Target

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics

PARTS = {
    "plant": (lambda loop: loop.plant, ("step", "sense", "truth")),
    "navigation": (lambda loop: loop.parts[topics.NAVIGATION].filter, ("step_screened",)),
    "planner": (lambda loop: loop.planner, ("step",)),
    "observer": (lambda loop: loop.parts[topics.DISTURBANCE_OBSERVER].law, ("step",)),
    "controller": (lambda loop: loop.parts[topics.CONTROLLER].law, ("step",)),
    "allocator": (lambda loop: loop.parts[topics.THRUST_ALLOCATOR].method, ("step",)),
}
TICKS, WARM = 1200, 100


def measure(full: bool) -> Iterator[Metric]:
    """A part's value is its mean time in a tick; its ratio is its share of the whole tick.

    Processor time, medians of blocks of one simulated second; the planner works in one tick of ten.
    """
    for name, suffix in (("manipulation", ""), ("hover", "_hover")):
        whole, *parts = np.median(_blocks(name), axis=0)
        factor = float(load_scenario(name).plant.control_period_s / whole)
        yield Metric(
            f"loop{suffix}",
            factor,
            "x real time",
            "real time; processor time of one core",
            factor,
            Target("value", ">=", 60.0),
        )
        yield Metric(f"loop_tick{suffix}", 1e6 * whole, "us")
        for part, seconds in zip(PARTS, parts, strict=True):
            share = float(seconds / whole)
            label = f"loop_tick_{part}{suffix}"
            yield Metric(label, 1e6 * float(seconds), "us", "the whole tick", share)


def _blocks(name: str) -> Any:
    """Mean time of a tick, and of each part in it, in every block (k, 1 + parts), s."""
    scenario = load_scenario(name)
    vehicle = scenario.load_vehicle()
    loop = Loop(scenario, vehicle)
    spent: dict[str, float] = defaultdict(float)
    for part, (of, methods) in PARTS.items():
        for method in methods:
            _watch(of(loop), method, part, spent)
    rows = []
    for index in range(WARM + TICKS):
        spent.clear()
        began = time.process_time()
        tick = loop.tick()
        goal = scenario.goal.build(vehicle, scenario.plant) if index == 0 else None
        if goal is not None:
            loop.planner.accept(goal)
        loop.advance(tick)
        rows.append([time.process_time() - began, *(spent[part] for part in PARTS)])
    return np.array(rows[WARM:]).reshape(-1, 20, 1 + len(PARTS)).mean(axis=1)


def _watch(target: Any, method: str, part: str, spent: dict[str, float]) -> None:
    """Let a method add its time to `spent[part]`."""
    work = getattr(target, method)

    def timed(*arguments: Any) -> Any:
        began = time.process_time()
        result = work(*arguments)
        spent[part] += time.process_time() - began
        return result

    setattr(target, method, timed)
