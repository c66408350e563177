"""The stamp of a message, read from its bytes alone."""

import struct

from uvms_core.signals import NANOSECONDS

_STAMP = struct.Struct("<iI")
_BEGIN = 4  # after the encapsulation header


def stamp_in(data: bytes) -> int | None:
    """Stamp (ns) of a message that begins with a std_msgs/Header; None where there is none.

    It can be read where the rest of the message cannot.
    """
    if len(data) < _BEGIN + _STAMP.size:
        return None
    sec, nanosec = _STAMP.unpack_from(data, _BEGIN)
    return None if nanosec >= NANOSECONDS or sec < 0 else sec * NANOSECONDS + nanosec
