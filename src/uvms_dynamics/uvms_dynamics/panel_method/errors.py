"""Errors of the panel method."""

from uvms_core.errors import UvmsError


class PanelMethodError(UvmsError):
    """A body does not suit the panel method, or the method finds no solution for it."""
