"""Errors of bringup: scenarios and runs."""

from uvms_core.errors import UvmsError


class BringupError(UvmsError):
    """Root of the errors of this package."""


class ScenarioError(BringupError):
    """A scenario is unknown, unreadable or names a value that is not allowed."""


class RunError(BringupError):
    """A run could not be started or did not complete."""


class CampaignError(BringupError):
    """A campaign is unknown, unreadable, names a value that is not allowed, or cannot be run."""


class ViewError(BringupError):
    """A view of a run cannot be shown or written."""


class ReportError(BringupError):
    """A report cannot be made as it was asked for."""
