"""One step of controller, observer and allocator in the loop, while the arm swings."""

import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from metrics import Metric, Target

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics

PARTS = {
    "controller": (lambda loop: loop.parts[topics.CONTROLLER].law, 80.0),
    "observer": (lambda loop: loop.parts[topics.DISTURBANCE_OBSERVER].law, 80.0),
    "allocator": (lambda loop: loop.parts[topics.THRUST_ALLOCATOR].method, 20.0),
}
"""Where the law of a part is, and the greatest time of its step, us."""
TICKS, WARM = 1200, 100


def measure(full: bool) -> Iterator[Metric]:
    """The median over the ticks, processor time; with what the law is told before its step."""
    spent = _spent()
    for part, (_, most) in PARTS.items():
        ticks = 1e6 * np.array(spent[part][WARM:])
        reference = f"its least time; median of {ticks.size} ticks, processor time"
        median = float(np.median(ticks))
        yield Metric(
            f"step_{part}",
            median,
            "us",
            reference,
            median / float(ticks.min()),
            Target("value", "<=", most),
        )


def _spent() -> dict[str, list[float]]:
    """Time of each part in every tick, s."""
    scenario = load_scenario("arm_swing")
    vehicle = scenario.load_vehicle()
    loop = Loop(scenario, vehicle)
    spent: dict[str, list[float]] = defaultdict(list)
    for part, (of, _) in PARTS.items():
        law = of(loop)
        for method in ("inform", "step"):
            if hasattr(law, method):
                setattr(law, method, _timed(getattr(law, method), spent[part]))
    for index in range(WARM + TICKS):
        for times in spent.values():
            times.append(0.0)
        tick = loop.tick()
        if index == 0 and (goal := scenario.goal.build(vehicle, scenario.plant)) is not None:
            loop.planner.accept(goal)
        loop.advance(tick)
    return spent


def _timed(work: Callable[..., Any], times: list[float]) -> Callable[..., Any]:
    """A method that adds its time to the last of `times`."""

    def timed(*arguments: Any) -> Any:
        began = time.process_time()
        result = work(*arguments)
        times[-1] += time.process_time() - began
        return result

    return timed
