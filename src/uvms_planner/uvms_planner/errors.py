"""The planner's branch of the exception tree."""

from uvms_core.errors import UvmsError


class PlannerError(UvmsError):
    """Root of what the motion planner raises on purpose."""


class GoalRejected(PlannerError):  # noqa: N818
    """A goal that cannot be followed; the text says which value, which bound and at which time."""
