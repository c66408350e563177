"""Errors of the control package; bad signals raise `uvms_core.errors.SignalError`."""

from uvms_core.errors import UvmsError


class ControlError(UvmsError):
    """Root of this package's own errors."""


class ControlSetupError(ControlError):
    """A controller or allocator was given gains, weights or limits that do not fit the vehicle."""


class AllocationError(ControlError):
    """A thrust allocation could not be computed."""
