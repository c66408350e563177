"""Errors of message definitions and bytes."""

from uvms_core.errors import UvmsError


class DefinitionError(UvmsError):
    """A message type is not installed, or its definition cannot be read."""


class CdrError(UvmsError):
    """Bytes are not a message of the type, or values do not fit it."""
