"""What libraries write to stderr by themselves, kept aside while a panel is on the screen."""

import os
import sys
import tempfile
from typing import TextIO

STDERR = 2


class StderrAside:
    """Puts the file descriptor of stderr aside: ROS's loggers write there past `sys.stderr`.

    A file takes it rather than a pipe, which would block whoever writes while nobody reads.
    """

    def __init__(self) -> None:
        sys.stderr.flush()
        self._terminal = os.dup(STDERR)
        self.console: TextIO = os.fdopen(self._terminal, "w", encoding=sys.stderr.encoding)
        """Writes to the terminal."""
        self._file = tempfile.TemporaryFile()
        self._read = 0
        os.dup2(self._file.fileno(), STDERR)

    def take(self) -> list[str]:
        """Whole lines written since the last call."""
        data = self._unread()
        data = data[: data.rfind(b"\n") + 1]
        self._read += len(data)
        return data.decode(errors="replace").splitlines()

    def end(self) -> None:
        """Put stderr back, and write there what nobody has taken."""
        os.dup2(self._terminal, STDERR)
        self.console.write(self._unread().decode(errors="replace"))
        self.console.close()
        self._file.close()

    def _unread(self) -> bytes:
        size = os.fstat(self._file.fileno()).st_size
        return os.pread(self._file.fileno(), size - self._read, self._read)
