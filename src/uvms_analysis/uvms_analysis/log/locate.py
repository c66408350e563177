"""The log that a path means: a file, or a folder with one log in it."""

from pathlib import Path

import yaml

from uvms_analysis.errors import LogError
from uvms_analysis.log.bag_metadata import NAME, ROOT

RUN_LOG = "run.mcap"


def log_path(path: str | Path) -> Path:
    """The file itself, or in a folder: run.mcap, what its metadata.yaml names, or its only log.

    Raises:
        LogError: the folder has no log, or several and nothing says which.
    """
    folder = Path(path)
    if not folder.is_dir():
        return folder
    if (folder / RUN_LOG).is_file():
        return folder / RUN_LOG
    named = _named(folder)
    logs = named or sorted(folder.glob("*.mcap"))
    if len(logs) != 1:
        names = ", ".join(log.name for log in logs) or "none"
        raise LogError(f"{folder}: holds no single log; name one of its files: {names}")
    return logs[0]


def _named(folder: Path) -> list[Path]:
    try:
        content = yaml.safe_load((folder / NAME).read_text(encoding="utf-8"))
        return [folder / Path(str(name)).name for name in content[ROOT]["relative_file_paths"]]
    except (OSError, ValueError, yaml.YAMLError, KeyError, TypeError):
        return []
