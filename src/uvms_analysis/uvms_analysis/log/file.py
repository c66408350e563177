"""The file of a log that is being written: nothing is buffered, and every error says why."""

import os
import zlib
from pathlib import Path

from uvms_analysis.errors import LogError


class LogFile:
    """A new file whose every write goes to the system at once, so that a killed process loses none.

    Args:
        path: of the file; its folder is made.
        overwrite: whether a file of that name may be replaced.

    Raises:
        LogError: the file exists, or it cannot be made.
    """

    def __init__(self, path: Path, overwrite: bool) -> None:
        self.path = path
        self.position = 0
        self.checksum = 0
        flags = os.O_TRUNC if overwrite else os.O_EXCL
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as fault:
            reason = f"its folder cannot be made: {fault.strerror}"
            raise LogError(f"log {path}: cannot be written: {reason}") from fault
        try:
            self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | flags, 0o644)
        except FileExistsError as fault:
            raise LogError(
                f"log {path}: exists already; give another folder, or remove it"
            ) from fault
        except OSError as fault:
            raise LogError(f"log {path}: cannot be written: {fault.strerror}") from fault

    def write(self, data: bytes) -> None:
        """All bytes at the end of the file; a file that took only a part is cut back to before.

        Raises:
            LogError: the disk is full, say; what was written before stays readable.
        """
        view = memoryview(data)
        try:
            while len(view):
                view = view[os.write(self._descriptor, view) :]
        except OSError as fault:
            self._cut_back()
            raise LogError(f"log {self.path}: cannot be written: {fault.strerror}") from fault
        self.checksum = zlib.crc32(data, self.checksum)
        self.position += len(data)

    def _cut_back(self) -> None:
        try:
            os.ftruncate(self._descriptor, self.position)
        except OSError:  # the reader finds the end of what is whole by itself
            pass

    def close(self) -> None:
        """Close the file.

        Raises:
            LogError: the system could not keep what was written.
        """
        try:
            os.close(self._descriptor)
        except OSError as fault:
            raise LogError(f"log {self.path}: cannot be closed: {fault.strerror}") from fault
