"""Errors of the panel method."""

from uvms_core.errors import UvmsError


class PanelMethodError(UvmsError):
    """A body cannot be given to the panel method, or the method has no answer for it."""
