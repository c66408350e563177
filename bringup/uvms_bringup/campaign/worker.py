"""What a worker does: one run, from its description to its row, whatever happens in it."""

import shutil
import traceback
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

from uvms_bringup.campaign.machine import OF_THE_MACHINE, is_of_the_machine
from uvms_bringup.campaign.plan import Run
from uvms_bringup.campaign.row import MISSING_LOG, Row, row_of, row_of_fault
from uvms_bringup.campaign.single import summary_of
from uvms_bringup.pace import Pace
from uvms_bringup.session import Session, git_revision, prepare
from uvms_core.errors import UvmsError

Logs = Literal["none", "failed", "all"]
LOGS_FOLDER = "logs"


def make_row(run: Run, folder: Path, logs: Logs) -> Row:
    """The row of a run; one that raises is a row with its reason.

    Args:
        folder: of the campaign, where the worker can write logs.
        logs: of which runs a log is kept; a run that failed is made once more for it, which gives
            the same.
    """
    try:
        if logs == "all":
            return _logged_row(run, folder)
        row = row_of(run, summary_of(run.load()))
        if logs == "failed" and not row["passed"] and not run.baseline_of:
            row |= _with_log(run, folder)[1]
        return row
    except UvmsError as fault:
        return row_of_fault(run, str(fault), is_of_the_machine(fault))
    except Exception as fault:  # a part of the user's may raise anything, and others still run
        where = traceback.extract_tb(fault.__traceback__)[-1]
        place = f"{Path(where.filename).name}:{where.lineno}"
        reason = f"{type(fault).__name__}: {fault} ({place})"
        return row_of_fault(run, reason, is_of_the_machine(fault))


def _logged_row(run: Run, folder: Path) -> Row:
    """The row of a run with its log; made without one where the log cannot be written."""
    summary, note = _with_log(run, folder)
    return row_of(run, summary or summary_of(run.load())) | note


def _with_log(run: Run, folder: Path) -> tuple[dict[str, Any], Row]:
    """The summary; empty, with a note for the row, where the machine did not take the log."""
    try:
        return logged(run, folder), {}
    except (UvmsError, *OF_THE_MACHINE) as fault:
        if not is_of_the_machine(fault):
            raise
        shutil.rmtree(_log_folder(run, folder), ignore_errors=True)  # half a log proves nothing
        return {}, {MISSING_LOG: str(fault)}


def logged(run: Run, folder: Path) -> dict[str, Any]:
    """The summary of a run whose folder, with its log, is kept in `logs`.

    Raises:
        UvmsError, OSError: the run cannot begin, or its log cannot be written to the end.
    """
    own = _log_folder(run, folder)
    shutil.rmtree(own, ignore_errors=True)  # of a worker that was killed
    command = f"uvms campaign, case {run.case}, seed {run.seed}"
    made = replace(session(run, str(own), command), quiet=True)
    summary = made.run_simulation()
    for fault in made.ended_by:
        if is_of_the_machine(fault):
            raise fault
    return summary


def _log_folder(run: Run, folder: Path) -> Path:
    return folder / LOGS_FOLDER / folder_name(run)


def folder_name(run: Run) -> str:
    """Name of a run's folder; what a file's name cannot have is `_`."""
    name = "".join(sign if sign.isalnum() or sign in " ._+=-,[]" else "_" for sign in run.case)
    return f"{name[:150]}-{run.seed}"


def session(run: Run, output: str | None, command: str) -> Session:
    """A run that is ready to be made with its log."""
    return prepare(run.load(), output, str(Pace()), command)


def about() -> str:
    """What the worker's program is."""
    return git_revision()
