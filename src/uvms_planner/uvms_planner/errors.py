"""Errors of the planner package."""

from uvms_core.errors import UvmsError


class PlannerError(UvmsError):
    """Base of the errors that the motion planner raises."""


class GoalRejected(PlannerError):  # noqa: N818
    """A goal that cannot be followed; the message names value, bound and time."""
