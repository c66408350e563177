"""Which thrusters the allocator took for weak, and since when; and when a node first said ERROR."""

from typing import Any

import numpy as np

from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.diagnostics import ERROR
from uvms_core.signals import to_seconds


def thruster_faults(log: RunLog) -> dict[str, dict[str, float | None]]:
    """When each weak thruster was named, by its name; empty where all are whole throughout.

    `at_s` is when its share first fell below 1, `effectiveness` the least share that was believed,
    and `until_s` when it was whole again, None where it stayed weak.

    Raises:
        LogError: the allocation cannot be read.
    """
    names = log.vehicle.thruster_names
    found: dict[str, dict[str, float | None]] = {}
    for allocation in log.signals(topics.ALLOCATION):
        shares = allocation.effectiveness
        if shares.size != len(names):  # of a log, or of a method, that does not know of health
            continue
        for i in np.flatnonzero(shares < 1.0):
            _weak(found.setdefault(names[i], {}), to_seconds(allocation.stamp), float(shares[i]))
        for name, fault in found.items():
            if fault["until_s"] is None and shares[names.index(name)] >= 1.0:
                fault["until_s"] = to_seconds(allocation.stamp)
    return found


def _weak(fault: dict[str, float | None], at_s: float, share: float) -> None:
    least = fault.setdefault("effectiveness", share)
    fault.setdefault("at_s", at_s)
    fault["effectiveness"] = share if least is None else min(share, least)
    fault["until_s"] = None


def errors_first_s(log: RunLog) -> dict[str, float]:
    """When each node first reported an ERROR on /diagnostics, s, by its name.

    Raises:
        LogError: /diagnostics cannot be read.
    """
    first: dict[str, float] = {}
    statuses: Any = log.signals(topics.DIAGNOSTICS) if log.has(topics.DIAGNOSTICS) else []
    for status in statuses:
        if status.level == ERROR:
            role = status.name.split(":")[0].strip().rsplit("/", 1)[-1]
            first.setdefault(role, to_seconds(status.stamp))
    return first
