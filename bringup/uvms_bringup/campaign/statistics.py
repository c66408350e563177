"""What the rows of a campaign come to: pass rates with their intervals, and spreads."""

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from uvms_bringup.campaign.bound import Bound
from uvms_bringup.campaign.plan import Variant
from uvms_bringup.campaign.row import Row

Z95 = 1.959963984540054
"""Quantile of the normal distribution for 95 % between -z and z."""


def wilson(passed: int, count: int, z: float = Z95) -> tuple[float, float]:
    """Interval of a rate of which `passed` of `count` trials were observed.

    Wilson, E. B. (1927): Probable inference, the law of succession, and statistical inference.
    Journal of the American Statistical Association 22 (158), 209-212. It is the set of rates p
    that the observed rate is within z standard deviations of, sqrt(p (1 - p) / count), and unlike
    the usual interval it holds its promise for few trials and for rates near 0 and 1.
    """
    if count == 0:
        return 0.0, 1.0
    rate, share = passed / count, z * z / count
    middle = (rate + share / 2.0) / (1.0 + share)
    half = z / (1.0 + share) * math.sqrt(rate * (1.0 - rate) / count + share / (4.0 * count))
    low = 0.0 if passed == 0 else middle - half
    high = 1.0 if passed == count else middle + half
    return low, high


def spread(field: str, bound: Bound, rows: Sequence[Row]) -> dict[str, Any]:
    """Median, 95th percentile and worst value of a field, and the seed of the worst.

    The worst value is the one that is farthest beyond the bound, or nearest to it.
    """
    found: dict[str, Any] = {"bound": str(bound), "min": bound.min, "max": bound.max}
    values: dict[int, Any] = {row["seed"]: row.get(field) for row in rows}
    known: dict[int, float] = {seed: value for seed, value in values.items() if is_number(value)}
    found["unknown"] = sum(value is None for value in values.values())
    found["broken"] = sum(bool(bound.fault(field, value)) for value in values.values())
    if not bound.is_numeric:
        return found | {"values": dict(Counter(map(str, values.values())))}
    if not known:
        return found | {"median": None, "p95": None, "worst": None, "worst_seed": None}
    worst = max(known, key=lambda seed: (bound.excess(known[seed]), -seed))
    numbers = list(known.values())
    return found | {
        "median": float(np.median(numbers)),
        "p95": float(np.percentile(numbers, 95)),
        "worst": known[worst],
        "worst_seed": worst,
    }


def is_number(value: Any) -> bool:
    """Whether a value of a row can be averaged."""
    return isinstance(value, int | float) and not isinstance(value, bool)


def case_statistics(required: Mapping[str, Bound], rows: Sequence[Row]) -> dict[str, Any]:
    """The statistics of one case, or of one of its baselines."""
    passed = sum(row["passed"] for row in rows)
    low, high = wilson(passed, len(rows))
    return {
        "runs": len(rows),
        "passed": passed,
        "pass_rate": passed / len(rows) if rows else None,
        "wilson_95": [low, high],
        "outcomes": dict(Counter(str(row.get("outcome")) for row in rows)),
        "fields": {name: spread(name, bound, rows) for name, bound in required.items()},
    }


def statistics(chosen: Sequence[Variant], rows: Sequence[Row]) -> dict[str, Any]:
    """By case: its statistics, with those of its baselines under `baselines`."""
    by_case: dict[str, list[Row]] = {}
    for row in rows:
        by_case.setdefault(row["case"], []).append(row)
    cases: dict[str, Any] = {}
    for one in chosen:
        found = case_statistics(one.required, by_case.get(one.case, []))
        if one.baseline_of:
            cases[one.baseline_of]["baselines"][one.case.removeprefix(f"{one.baseline_of}/")] = (
                found
            )
        else:
            cases[one.case] = found | {"planned": len(one.seeds), "baselines": {}}
    return cases
