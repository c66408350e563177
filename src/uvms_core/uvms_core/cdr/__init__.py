"""Message definitions and CDR, the format of messages on the wire and in logs, without ROS."""

from uvms_core.cdr.codec import Codec, codec
from uvms_core.cdr.definitions import schema_text, type_hash
from uvms_core.errors import CdrError, DefinitionError

__all__ = ["CdrError", "Codec", "DefinitionError", "codec", "schema_text", "type_hash"]
