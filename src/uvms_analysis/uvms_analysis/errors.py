"""Errors of the analysis: logs and trials."""

from uvms_core.errors import UvmsError


class AnalysisError(UvmsError):
    """Root of the errors of this package."""


class LogError(AnalysisError):
    """A log is missing, unreadable or lacks the requested data."""


class TrialError(AnalysisError):
    """A recorded trial is unreadable, lacks values, or does not fit the vehicle."""
