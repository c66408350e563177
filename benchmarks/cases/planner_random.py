"""Random paths: refusals, limits at 1 kHz, tool error, clearance, J against the arm held still."""

import json
from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target
from path_oracle import possible
from path_trial import NEAR_M, Outcome, Trial
from random_paths import RandomGoal, random_goals
from run import log

from uvms_core.vehicle import Vehicle, load_vehicle
from uvms_core.vehicle.locate import vehicle_path

SEED = 20261126
COUNTS = {"reference_auv": 200, "bluerov2_alpha5": 50}
FEW = 10
"""A run that is not full takes this part of them."""
COARSE_S = 0.05
"""Between two samples of what is only compared by J."""


def measure(full: bool) -> Iterator[Metric]:
    """200 goals of one vehicle and 50 of another; the tenth part of them unless full."""
    for name, count in COUNTS.items():
        vehicle = load_vehicle(vehicle_path(name))
        goals = random_goals(vehicle, count if full else count // FEW, SEED)
        yield from metrics_of(name, [tried(vehicle, goal) for goal in goals])


Tried = tuple[RandomGoal, Outcome, float, str]
"""A goal, what became of it, J with the arm held still, and how it could have been followed."""


def tried(vehicle: Vehicle, goal: RandomGoal) -> Tried:
    """One goal by the default method, and by what it is compared with."""
    outcome = Trial(vehicle, goal, "genetic").outcome()
    held = Trial(vehicle, goal, "vehicle_only", COARSE_S).outcome() if outcome.accepted else None
    still = held.disturbance if held and held.finished else np.nan
    oracle = "" if outcome.finished else possible(vehicle, goal)
    log(f"{goal}: {json.dumps(_line(outcome, still, oracle))}")
    return goal, outcome, still, oracle


def _line(outcome: Outcome, still: float, oracle: str) -> dict:
    if not outcome.finished:
        return {"refused": outcome.words, "oracle": oracle, "seconds": round(outcome.seconds, 1)}
    return {
        "J": float(f"{outcome.disturbance:.3g}"), "held": float(f"{still:.3g}"),
        "worst": f"{outcome.worst:.4f} {outcome.limit}",
        "tool mm": round(1e3 * outcome.tool_error, 4),
        "clear mm": round(1e3 * outcome.clearance, 1),
        "kept mm": round(1e3 * outcome.kept_clearance, 1),
        "stop deg": round(np.rad2deg(outcome.stop), 2), "seconds": round(outcome.seconds, 2),
    }  # fmt: skip


def metrics_of(name: str, results: list[Tried]) -> Iterator[Metric]:
    """What the targets speak of."""
    count = len(results)
    done = [(goal, out, still) for goal, out, still, _ in results if out.finished]
    wrong = sum(bool(oracle) for *_, oracle in results)
    of = f"{count} random paths"
    yield Metric(f"{name}_refused", float(count - len(done)), "1", of)
    yield Metric(f"{name}_refused_wrongly", float(wrong), "1", f"{of}, by the oracle",
                 wrong / count, Target("ratio", "<=", 0.01))  # fmt: skip
    outcomes = [out for _, out, _ in done]
    over = sum(out.worst > 1.001 for out in outcomes)
    yield Metric(f"{name}_over_a_limit", float(over), "1", f"{len(done)} plans, at 1 kHz",
                 target=Target("value", "<=", 0.0))  # fmt: skip
    yield Metric(f"{name}_worst_share", max(out.worst for out in outcomes), "1", "of any limit",
                 target=Target("value", "<=", 1.001))  # fmt: skip
    yield Metric(f"{name}_tool_error", 1e3 * max(out.tool_error for out in outcomes), "mm",
                 "between the knots", target=Target("value", "<=", 0.05))  # fmt: skip
    ratios = [out.disturbance / still for _, out, still in done if np.isfinite(still)]
    worse = sum(ratio > 1.0 for ratio in ratios)
    yield Metric(f"{name}_worse_than_held", float(worse), "1",
                 f"{len(ratios)} paths that vehicle_only can follow",
                 target=Target("value", "<=", 0.0))  # fmt: skip
    yield Metric(f"{name}_median_against_held", float(np.median(ratios)), "1", "vehicle_only's J")
    yield Metric(f"{name}_clearance", 1e3 * min(out.kept_clearance for out in outcomes), "mm",
                 "of arm and hull, pairs that begin beyond 30 mm",
                 target=Target("value", ">=", 1e3 * NEAR_M - 0.1))  # fmt: skip
    yield Metric(f"{name}_least_clearance", 1e3 * min(out.clearance for out in outcomes), "mm",
                 "of all pairs of arm and hull")  # fmt: skip
    yield Metric(f"{name}_joint_stop", float(np.rad2deg(min(out.stop for out in outcomes))), "deg",
                 "least distance", target=Target("value", ">=", 1.9))  # fmt: skip
    for share in (50, 95, 100):
        seconds = np.percentile([out.seconds for out in outcomes], share)
        yield Metric(f"{name}_seconds_p{share}", float(seconds), "s", "to accept a path")
    refused = [out.seconds for _, out, *_ in results if not out.accepted]
    if refused:
        yield Metric(f"{name}_seconds_to_refuse", float(np.median(refused)), "s", "median")
