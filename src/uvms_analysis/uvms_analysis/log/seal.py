"""Checksums of what MCAP leaves without one: metadata, and which attachments a log has."""

import hashlib
import json
import zlib
from collections.abc import Mapping

KEY = "crc32"
"""Value of a metadata record that the reader checks and takes away."""
ATTACHMENTS = "attachments"
"""Name of the metadata record with the SHA-256 of each attachment."""


def digest(data: bytes) -> str:
    """SHA-256 of an attachment."""
    return hashlib.sha256(data).hexdigest()


def sealed(values: Mapping[str, str]) -> dict[str, str]:
    """The values with their checksum, which does not depend on their order."""
    plain = {key: value for key, value in values.items() if key != KEY}
    return plain | {KEY: _checksum(plain)}


def unsealed(values: Mapping[str, str]) -> dict[str, str] | None:
    """The values without their checksum; None where it does not fit them."""
    plain = {key: value for key, value in values.items() if key != KEY}
    return plain if values.get(KEY, _checksum(plain)) == _checksum(plain) else None


def _checksum(values: Mapping[str, str]) -> str:
    return f"{zlib.crc32(json.dumps(sorted(values.items())).encode()):08x}"
