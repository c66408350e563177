"""One tick of the whole loop in process, part by part, along the manipulation."""

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
    scenario = load_scenario("manipulation")
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
        if index == 0:
            loop.planner.accept(scenario.goal.build(vehicle, scenario.plant))
        loop.advance(tick)
        rows.append([time.process_time() - began, *(spent[part] for part in PARTS)])
    blocks = np.array(rows[WARM:]).reshape(-1, 20, 1 + len(PARTS)).mean(axis=1)
    whole, *parts = np.median(blocks, axis=0)
    factor = float(scenario.plant.control_period_s / whole)
    yield Metric(
        "loop",
        factor,
        "x real time",
        "real time; processor time of one core",
        factor,
        Target("value", ">=", 30.0),
    )
    yield Metric("loop_tick", 1e6 * whole, "us")
    for part, seconds in zip(PARTS, parts, strict=True):
        share = float(seconds / whole)
        yield Metric(f"loop_tick_{part}", 1e6 * float(seconds), "us", "the whole tick", share)


def _watch(target: Any, method: str, part: str, spent: dict[str, float]) -> None:
    """Let a method add its time to `spent[part]`."""
    work = getattr(target, method)

    def timed(*arguments: Any) -> Any:
        began = time.process_time()
        result = work(*arguments)
        spent[part] += time.process_time() - began
        return result

    setattr(target, method, timed)
