"""Errors of the panel method."""

from uvms_dynamics.errors import UvmsError


class PanelMethodError(UvmsError):
    """A body cannot be given to the panel method, or the method has no answer for it."""
