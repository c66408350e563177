"""The program `uvms`: guards the command line from its first import to its last line of output.

It imports nothing of its own at the top, so that Ctrl-C during the imports ends as at any other
time: in one line.
"""

import os
import signal
import sys

INTERRUPTED = 130
INTERNAL_ERROR = 70  # EX_SOFTWARE of sysexits.h
TRACEBACK = "UVMS_TRACEBACK"
"""Environment variable: set, an internal error shows where it arose."""


def main() -> int:
    """Run the command line of this process; returns its exit code."""
    try:
        _open_streams()
        _take_signals()
        _print_any_text()
        from uvms_bringup.cli import main as run

        return _flushed(run())
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    except Exception as fault:
        return _internal_error(fault)


def _open_streams() -> None:
    """Streams that were closed lead nowhere; a log that is opened must not take their numbers."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
            setattr(sys, name, open(number, "w" if number else "r", closefd=False))


def _take_signals() -> None:
    """Whoever started this program may have blocked them; ROS does in its own processes."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, (signal.SIGINT, signal.SIGTERM))


def _print_any_text() -> None:
    """A terminal that cannot show a character gets its code instead of an error."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")


def _flushed(code: int) -> int:
    """The exit code; what is still to be printed fails here rather than at the very end."""
    try:
        sys.stdout.flush()
    except OSError as fault:  # the disk is full, or the reader has gone
        print(f"error: the output cannot be written: {fault.strerror}", file=sys.stderr)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return code or 2
    return code


def _internal_error(fault: Exception) -> int:
    """A mistake of ours, in one line: users need what happened, developers the traceback."""
    if os.environ.get(TRACEBACK):
        import traceback

        traceback.print_exc()
    print(
        f"internal error: {type(fault).__name__}: {fault}\nThis is a mistake in the program:"
        f" please report it with the command that you typed. {TRACEBACK}=1 shows where it arose.",
        file=sys.stderr,
    )
    return INTERNAL_ERROR


if __name__ == "__main__":
    raise SystemExit(main())
