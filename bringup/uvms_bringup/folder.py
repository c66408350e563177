"""The output folder of a run: made, and claimed for this run alone."""

import sys
from datetime import datetime, timezone
from pathlib import Path

from uvms_bringup.claim import Claim, Holder, TakenError
from uvms_bringup.errors import RunError

LOG_FILE = "run.mcap"
CLAIM_FILE = ".run.lock"


def new_folder(name: str) -> Path:
    """Where the results of a run go that does not say where: below the working directory."""
    return Path("runs") / f"{name}-{datetime.now(timezone.utc):%Y%m%dT%H%M%SZ}"


def claim_folder(folder: Path, holder: Holder) -> tuple[Path, Claim]:
    """Make a folder and claim it; returns its full path and the claim.

    Raises:
        RunError: it cannot be made, another run has it, or it holds a run already.
    """
    given = folder
    try:
        folder = given.resolve()
        folder.mkdir(parents=True, exist_ok=True)
        claim = Claim(folder / CLAIM_FILE, holder)
    except TakenError as other:
        raise RunError(
            f"--output {given}: belongs to {other}, which is still running; give another --output"
        ) from other
    except OSError as fault:
        raise RunError(f"--output {given}: {_why(fault)}") from fault
    if (folder / LOG_FILE).exists():
        claim.release()
        raise RunError(f"{given} holds a run already; give another --output, or remove it")
    if claim.left_by is not None:
        print(f"note: {folder} was left without a log by {claim.left_by}", file=sys.stderr)
    return folder, claim


def _why(fault: OSError) -> str:
    if isinstance(fault, FileNotFoundError):
        return "the working directory, or a folder of this path, has been deleted"
    return fault.strerror or str(fault)
