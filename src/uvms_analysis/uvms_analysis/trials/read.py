"""Read a folder of trials: one CSV each, as in bringup/data/pool_trials."""

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.plausible import check_angles, gap_notes, optional_columns, tilt_notes
from uvms_core.signals import Array

NEEDED = (
    "t", "x", "y", "z", "roll", "pitch", "yaw", "gx", "gy", "gz", "q_b", "q_c", "q_d", "q_e",
)  # fmt: skip
"""Columns that a trial must have; `moc_ok` may be absent (all samples then count)."""

_QUATERNION = ("qw", "qx", "qy", "qz")
_SENSOR = ("imu_roll", "imu_pitch")
INERTIAL = (*_SENSOR, "imu_yaw", "acx", "acy", "acz")
OPTIONAL = (*_QUATERNION, *INERTIAL)
"""Columns that are used for checks and comparison only, where they are present."""

Log = Callable[[str], None]

MIN_SAMPLES = 25
"""Samples that a trial must have."""


@dataclass(frozen=True)
class Trial:
    """One trial, in its own convention: forward-left-up, degrees for attitudes, SI otherwise."""

    name: str
    t: Array  # (k,) s
    position: Array  # (k, 3) m, world with z up
    attitude: Array  # (k, 3) roll, pitch (nose down), yaw, degrees
    gyro: Array  # (k, 3) rad/s
    alpha: Array  # (k, 4) measured axes e, d, c, b of the arm, rad: base to wrist
    accepted: NDArray[np.bool_]  # (k,) whether the motion capture may be scored
    sensor: Array | None = None  # (k, 2) roll, pitch of the vehicle's own attitude sensor, degrees
    inertial: Array | None = None  # (k, 6) its roll, pitch, yaw, degrees; specific force, m/s^2

    @property
    def tilt(self) -> Array:
        """Measured roll and pitch (k, 2), degrees."""
        return self.attitude[:, :2]


def read_trials(folder: str | Path, log: Log = lambda note: None) -> list[Trial]:
    """Every `*.csv` of the folder, by name; `log` gets notes on oddities that are not errors.

    Raises:
        TrialError: no such folder, no CSV in it, or a file that is not a trial; the message names
            the file, and the line and column of a missing or wrong value.
    """
    folder = Path(folder)
    if not folder.is_dir():
        raise TrialError(f"{folder}: no such folder; it must hold one CSV a trial")
    files = sorted(folder.glob("*.csv"))
    if not files:
        raise TrialError(f"{folder}: holds no *.csv, so there are no trials in it")
    return [read_trial(file, log) for file in files]


def read_trial(file: Path, log: Log = lambda note: None) -> Trial:
    """One trial; raises TrialError as `read_trials`."""
    columns = _columns(file)
    t = columns["t"]
    _check_time(file, t)
    accepted = columns.get("moc_ok", np.ones(len(t))) > 0.5
    if not accepted.any():
        raise TrialError(f"{file}: column moc_ok: is 0 throughout, so nothing can be scored")
    sensor, inertial = (_whole(columns, *names) for names in (_SENSOR, INERTIAL))
    trial = Trial(
        file.stem,
        t,
        _stack(columns, "x", "y", "z"),
        _stack(columns, "roll", "pitch", "yaw"),
        _stack(columns, "gx", "gy", "gz"),
        _stack(columns, "q_e", "q_d", "q_c", "q_b"),
        accepted,
        sensor,
        inertial,
    )
    check_angles(file, trial.alpha)
    for note in (
        *tilt_notes(file, trial.tilt, optional_columns(columns, *_QUATERNION)),
        *gap_notes(file, t),
    ):
        log(f"note: {note}")
    return trial


def _whole(columns: dict[str, Array], *names: str) -> Array | None:
    """Optional columns (k, n); None if one is absent or has a gap."""
    found = optional_columns(columns, *names)
    return found if found is not None and np.isfinite(found).all() else None


def _columns(file: Path) -> dict[str, Array]:
    try:
        with file.open(newline="", encoding="utf-8") as lines:
            rows = list(csv.reader(lines))
    except (OSError, UnicodeDecodeError, csv.Error) as fault:
        raise TrialError(f"{file}: cannot be read: {fault}") from fault
    header = [name.strip() for name in rows[0]] if rows else []
    missing = [name for name in NEEDED if name not in header]
    if missing:
        raise TrialError(
            f"{file}: line 1: lacks the column {', '.join(missing)}; a trial has"
            f" {', '.join(NEEDED)} and may have moc_ok"
        )
    names = [name for name in (*NEEDED, "moc_ok", *OPTIONAL) if name in header]
    places = [header.index(name) for name in names]
    values = np.empty((len(rows) - 1, len(names)))
    for line, row in enumerate(rows[1:], start=2):
        for k, (name, place) in enumerate(zip(names, places, strict=True)):
            text = row[place] if place < len(row) else ""
            read = _number_or_nan if name in OPTIONAL else _number
            values[line - 2, k] = read(file, line, name, text)
    if len(values) < MIN_SAMPLES:
        raise TrialError(f"{file}: has {len(values)} samples; a trial has at least {MIN_SAMPLES}")
    return dict(zip(names, values.T, strict=True))


def _number(file: Path, line: int, name: str, text: str) -> float:
    where = f"{file}: line {line}: column {name}"
    if not text.strip():
        raise TrialError(f"{where}: the value is missing; fill it in or leave the row out")
    try:
        value = float(text)
    except ValueError:
        raise TrialError(f"{where}: {text!r} is not a number") from None
    if not math.isfinite(value):
        raise TrialError(f"{where}: {text!r} is not finite; fill it in or leave the row out")
    return value


def _number_or_nan(file: Path, line: int, name: str, text: str) -> float:
    try:
        return _number(file, line, name, text)
    except TrialError:
        return math.nan


def _check_time(file: Path, t: Array) -> None:
    backward = np.flatnonzero(np.diff(t) <= 0.0)
    if len(backward):
        line = int(backward[0]) + 3
        raise TrialError(
            f"{file}: line {line}: column t: {t[line - 2]:g} must be later than {t[line - 3]:g}"
        )


def _stack(columns: dict[str, Array], *names: str) -> Array:
    return np.stack([columns[name] for name in names], axis=1)
