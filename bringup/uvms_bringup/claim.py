"""Something that one run at a time may use: its output folder, a ROS domain.

A claim is a lock on a file that says whose it is. The kernel gives the lock up when the process
ends, however it ends, so that nothing stays taken by a run that is gone.
"""

import fcntl
import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path

from uvms_bringup.errors import BringupError


@dataclass(frozen=True)
class Holder:
    """Who has a claim."""

    run_id: str
    process: int
    command: str

    def __str__(self) -> str:
        return f"run {self.run_id} (process {self.process}: {self.command})"


class TakenError(BringupError):
    """Another process has the claim; `str` says who."""


class Claim:
    """The lock on one file, held until `release` or the end of the process.

    Raises:
        TakenError: somebody else has it.
        OSError: the file cannot be made or locked.
    """

    def __init__(self, path: Path, holder: Holder) -> None:
        self.path = path
        self.left_by, self._descriptor = _lock(path)
        os.ftruncate(self._descriptor, 0)
        os.pwrite(self._descriptor, json.dumps(asdict(holder)).encode(), 0)

    left_by: Holder | None
    """Who had it last and did not release it: its process was killed."""

    def release(self) -> None:
        """Give it up; harmless when repeated."""
        if self._descriptor >= 0:
            descriptor, self._descriptor = self._descriptor, -1
            self.path.unlink(missing_ok=True)
            os.close(descriptor)


def _lock(path: Path) -> tuple[Holder | None, int]:
    while True:
        descriptor = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as fault:
            holder = _read(descriptor)
            os.close(descriptor)
            if isinstance(fault, BlockingIOError):
                raise TakenError(str(holder or "another run")) from fault
            raise
        if _is_still(path, descriptor):
            return _read(descriptor), descriptor
        os.close(descriptor)  # its holder removed it between the two calls


def _is_still(path: Path, descriptor: int) -> bool:
    try:
        return os.path.samestat(os.stat(path), os.fstat(descriptor))
    except FileNotFoundError:
        return False


def _read(descriptor: int) -> Holder | None:
    try:
        return Holder(**json.loads(os.pread(descriptor, 4096, 0)))
    except (ValueError, TypeError):
        return None
