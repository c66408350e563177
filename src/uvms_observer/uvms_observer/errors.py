"""Errors of the observer package; bad signals raise `uvms_core.errors.SignalError`."""

from uvms_core.errors import UvmsError


class ObserverError(UvmsError):
    """Root of this package's own errors."""


class NotAlignedError(ObserverError):
    """The navigation filter has had no IMU sample yet, and so no attitude to start from."""
