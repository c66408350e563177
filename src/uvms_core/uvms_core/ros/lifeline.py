"""A node that a run started ends with the run, however the run ends.

The run tells its children its process id in an environment variable and keeps the other end of
their standard input: it sends GO when the node may enter the graph, and the end of the stream means
that the run is gone. On Linux the kernel ends the child as well, even one that hangs. A node that
is started by hand has no such variable, and nothing here affects it.
"""

import ctypes
import os
import signal
import sys
import threading

PARENT = "UVMS_RUN_PROCESS"
"""Environment variable: process id of the run that starts a node."""
GO = b"go\n"
"""What the run sends when the node may enter the graph."""
ORPHANED = 1
"""Exit code of a node whose run has gone."""

STDIN = 0
"""File descriptor, read without a buffer: a thread that waits in one blocks Python's shutdown."""

_PR_SET_PDEATHSIG = 1


def hold_on() -> None:
    """Tie this process to the run that started it and wait until it lets the node in.

    Returns at once in a process that no run started. Does not return if the run has gone.
    """
    parent = os.environ.pop(PARENT, "")  # what the node itself starts is no child of the run
    if not parent:
        return
    _die_with_parent()
    if os.getppid() != int(parent):  # it died before the line above took effect
        os._exit(ORPHANED)
    if os.read(STDIN, len(GO)) != GO:
        os._exit(ORPHANED)
    threading.Thread(target=_watch, daemon=True).start()


def _die_with_parent() -> None:
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)


def _watch() -> None:
    """Where the kernel does not tell, the end of the stream does."""
    while os.read(STDIN, len(GO)):
        pass
    os._exit(ORPHANED)
