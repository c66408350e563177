"""Errors of bringup: scenarios, runs and logs."""

from uvms_dynamics.errors import UvmsError


class BringupError(UvmsError):
    """Root of the errors of this package."""


class ScenarioError(BringupError):
    """A scenario is unknown, unreadable or names a value that is not allowed."""


class RunError(BringupError):
    """A run could not be started or did not come to its end."""


class LogError(BringupError):
    """A log is missing, unreadable or lacks what was asked of it."""


class TrialError(BringupError):
    """A recorded trial is unreadable, lacks values, or cannot be driven by the vehicle given."""
