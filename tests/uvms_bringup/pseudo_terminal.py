"""A command on a pseudo terminal, and what stands on its screen."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import termios
import time
from collections.abc import Mapping, Sequence

ESCAPE = re.compile(r"\x1b\[(\??[\d;]*)([A-Za-z])")


class Screen:
    """Lines of a terminal of unlimited height; knows what a live panel uses, and nothing more."""

    def __init__(self) -> None:
        self.lines = [""]
        self.is_cursor_shown = True
        self._row = self._column = 0

    def feed(self, text: str) -> None:
        place = 0
        while place < len(text):
            if found := ESCAPE.match(text, place):
                self._obey(*found.groups())
                place = found.end()
            else:
                self._put(text[place])
                place += 1

    def _put(self, letter: str) -> None:
        if letter == "\r":
            self._column = 0
        elif letter == "\n":
            self._row += 1
            self.lines += [""] * (self._row + 1 - len(self.lines))
        else:
            line = self.lines[self._row].ljust(self._column)
            self.lines[self._row] = line[: self._column] + letter + line[self._column + 1 :]
            self._column += 1

    def _obey(self, arguments: str, command: str) -> None:
        if command == "A":
            self._row = max(self._row - int(arguments or 1), 0)
        elif command == "K":
            assert arguments == "2", arguments
            self.lines[self._row] = ""
        elif command in "hl":
            assert arguments == "?25", arguments
            self.is_cursor_shown = command == "h"
        else:
            assert command == "m", (arguments, command)  # colours

    @property
    def text(self) -> str:
        return "\n".join(line.rstrip() for line in self.lines).rstrip()


class Terminal:
    """A command on a terminal of so many columns and rows; a context manager."""

    def __init__(
        self, command: Sequence[str], columns: int, rows: int = 60, **environment: str
    ) -> None:
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self._process = subprocess.Popen(
            command,
            stdin=slave,
            stdout=slave,
            stderr=slave,
            env=_environment(environment),
            start_new_session=True,
        )
        os.close(slave)
        self._data = b""

    @property
    def raw(self) -> str:
        """Everything that was written so far."""
        return self._data.decode(errors="ignore")

    def __enter__(self) -> "Terminal":
        return self

    def __exit__(self, *_: object) -> None:
        if self._process.poll() is None:
            self._process.kill()
        self._process.wait()
        os.close(self._master)

    def read_until(self, *words: str, patience_s: float) -> None:
        """Read until the words were shown in this order; AssertionError if they do not come."""
        until = time.monotonic() + patience_s
        while not _in_order(self.raw, words):
            is_going_on = self._read()
            missing = f"no {' ... '.join(words)} in:\n{self.raw}"
            assert is_going_on or _in_order(self.raw, words), missing
            assert time.monotonic() < until, missing

    def press_ctrl_c(self) -> None:
        self._process.send_signal(signal.SIGINT)

    def end(self, patience_s: float) -> int:
        """Read to the end; the exit code."""
        until = time.monotonic() + patience_s
        while self._read():
            assert time.monotonic() < until, self.raw
        return self._process.wait(patience_s)

    def screen(self) -> Screen:
        """What stands on the screen now."""
        screen = Screen()
        screen.feed(self.raw)
        return screen

    def _read(self) -> bool:
        if not select.select([self._master], [], [], 0.5)[0]:
            return self._process.poll() is None
        try:
            data = os.read(self._master, 65536)
        except OSError:  # the other end is closed
            return False
        self._data += data
        return bool(data)


def _in_order(text: str, words: Sequence[str]) -> bool:
    place = 0
    for each in words:
        if (place := text.find(each, place)) < 0:
            return False
    return True


OTHERS = ("NO_COLOR", "CI", "COLUMNS", "LINES")
"""Variables that speak of another terminal; a test runner of several processes sets some."""


def _environment(own: Mapping[str, str]) -> dict[str, str]:
    values = {name: text for name, text in os.environ.items() if name not in OTHERS}
    return values | {"TERM": "xterm-256color"} | dict(own)
