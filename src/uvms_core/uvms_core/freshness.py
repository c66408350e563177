"""How old an input may be: in real time a node goes on with the newest that it has."""

from uvms_core.errors import SignalError
from uvms_core.signals import to_nanoseconds

MAX_AGE_S = 0.5
"""Oldest joint state or disturbance that control works with, s: a planner step."""


def check_age(name: str, stamp: int, now: int, limit_s: float = MAX_AGE_S) -> None:
    """Check that an input of `stamp` can be used at `now` (both ns).

    Raises:
        SignalError: it is of later than now, or older than `limit_s`.
    """
    if not 0 <= now - stamp <= to_nanoseconds(limit_s):
        raise SignalError(
            f"{name}: stamp {stamp} ns; it must lie within {limit_s:g} s before the odometry's,"
            f" {now} ns"
        )
