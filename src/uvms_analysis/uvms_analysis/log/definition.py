"""Message definitions in a log, which may be damaged or another program's."""

import struct
from functools import cache

from uvms_analysis.errors import LogError
from uvms_core.cdr import CdrError, Codec, DefinitionError, schema_text
from uvms_core.cdr.parse import parse_schema
from uvms_core.errors import SignalError

UNDECODABLE = (
    SignalError,
    CdrError,
    AttributeError,
    KeyError,
    TypeError,
    ValueError,
    IndexError,
    OverflowError,
    MemoryError,
    struct.error,
)
"""Raised where bytes are not a message of the type, or the message is not a valid signal."""

_UNREADABLE = (DefinitionError, UnicodeDecodeError, KeyError, ValueError, SyntaxError)
"""SyntaxError: a codec is compiled, and a field's name may be no name."""


@cache
def _compiled(type_name: str, text: bytes) -> Codec:
    return Codec(type_name, text.decode())


def log_codec(what: str, type_name: str, text: bytes) -> Codec:
    """The codec of a type from the definition in a log; `what` names the topic in the error.

    Raises:
        LogError: the definition cannot be read.
    """
    try:
        return _compiled(type_name, text)
    except (*_UNREADABLE, RecursionError, StopIteration, TypeError, IndexError) as fault:
        raise LogError(f"{what}: the definition of {type_name!r} is damaged: {fault}") from fault


def same_definition(type_name: str, text: str) -> bool:
    """Whether a readable definition has the fields of the type that is installed here."""
    try:
        return parse_schema(type_name, text) == parse_schema(type_name, schema_text(type_name))
    except DefinitionError:
        return True  # not installed: nothing to compare it with
