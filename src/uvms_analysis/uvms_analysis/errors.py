"""Errors of the analysis: logs and trials."""

from collections.abc import Callable
from typing import TypeVar

from uvms_core.errors import UvmsError

T = TypeVar("T")

NOT_THESE = (ValueError, IndexError, KeyError, TypeError, ArithmeticError)
"""Raised by the mathematics on the values of a foreign log; LogError where the log is damaged."""


class AnalysisError(UvmsError):
    """Root of the errors of this package."""


class LogError(AnalysisError):
    """A log is missing, unreadable or lacks the requested data."""


class TrialError(AnalysisError):
    """A recorded trial is unreadable, lacks values, or does not fit the vehicle."""


def determine(work: Callable[[], T]) -> T:
    """What `work` finds out from a log.

    Raises:
        LogError: the log does not determine it; says why, whatever `work` failed with.
    """
    try:
        return work()
    except NOT_THESE as fault:
        raise LogError(f"the log's values do not fit together: {fault!r}") from fault
