"""What the commands of docs/tour.md print, put into the page again: `make pictures ARGS=tour`."""

import contextlib
import io
import os
import re
import shlex
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path

from uvms_bringup.cli import main

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "tour.md"
EXAMPLES = ROOT / "examples"
BLOCK = re.compile(r"(?<=^```\n)uvms (?:simulate|compare) .*?(?=^```$)", re.MULTILINE | re.DOTALL)
"""A command whose output the page shows, in part."""


def blocks(page: str) -> list[tuple[str, ...]]:
    """Lines of each such block: the command, and what it prints of note."""
    return [tuple(text.splitlines()) for text in BLOCK.findall(page)]


def printed_again(page: str, folder: Path) -> str:
    """The page with the numbers of today.

    Args:
        page: its text; which lines of the output it shows stays as it is.
        folder: working directory of the commands, where their runs go.

    Raises:
        LookupError: a command does not print a line any more that the page shows.
    """
    with _working_in(folder):
        return BLOCK.sub(lambda block: _printed(*block[0].splitlines()), page)


def _printed(command: str, *shown: str) -> str:
    output = _output(command)
    lines = [command, *_chosen(shown, output, command)]
    return "".join(f"{line}\n" for line in lines)


def _chosen(shown: Iterable[str], output: str, command: str) -> Iterator[str]:
    """The lines of the output, in its order, that are about what the shown ones are about."""
    left = iter(output.splitlines())
    for line in shown:
        subject = _subject(line)
        found = next((each for each in left if _subject(each) == subject), None)
        if found is None:
            raise LookupError(f"{command}\nprints no line (any more) of {subject!r}:\n{output}")
        yield found


def _subject(line: str) -> str:
    """What a line is about: `roll` of `roll: 0.1 deg rms`, the first column of a table."""
    return re.split(r":|  ", line)[0]


def _output(command: str) -> str:
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        code = main(shlex.split(command)[1:])
    if code not in (0, 1):
        raise SystemExit(f"{command}\nended with code {code}\n{out.getvalue()}")
    return out.getvalue()


@contextlib.contextmanager
def _working_in(folder: Path) -> Iterator[None]:
    """In this folder, with the modules of the examples at hand."""
    before = os.getcwd()
    os.chdir(folder)
    sys.path.insert(0, str(EXAMPLES))
    try:
        yield
    finally:
        sys.path.remove(str(EXAMPLES))
        os.chdir(before)
