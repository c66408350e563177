"""The word `csv`: a path from a table of times, positions and, where it has them, orientations."""

import csv
from pathlib import Path
from typing import Any, Self

import numpy as np
from pydantic import Field, model_validator
from scipy.spatial.transform import Rotation

from uvms_core.checks import is_unit
from uvms_core.signals import Array
from uvms_planner.paths.shape import (
    AT_ORIGIN,
    FARTHEST_M,
    LONGEST_PATH_S,
    Begin,
    PathPoints,
    PathShape,
)
from uvms_planner.paths.spline import dense_times, through, turned

POSITION = ("t", "x", "y", "z")
ORIENTATION = ("qx", "qy", "qz", "qw")
MOST_ROWS = 100_000
"""A day at one point a second; more of them would make the goal a message of megabytes."""


class CsvPath(PathShape):
    """A table with a header line and the columns t, x, y, z, and qx, qy, qz, qw where wanted.

    Seconds from 0; metres and the tool's orientation in the path's frame: from its pose at the
    start, or absolute. Between the rows the path is as smooth as through `waypoints`.
    """

    file: str = Field(
        min_length=1,
        description="CSV file; relative to the scenario's file, on the command line to the working"
        " directory",
    )
    scale: float = Field(1.0, gt=0.0, le=1000.0, description="factor on the positions of the table")

    @model_validator(mode="before")
    @classmethod
    def _may_be_a_file_name(cls, data: Any) -> Any:
        return {"file": data} if isinstance(data, str) else data

    @model_validator(mode="after")
    def _is_readable(self) -> Self:
        read_table(Path(self.file))
        return self

    @property
    def seconds(self) -> float:
        """To the last row, s."""
        return float(read_table(Path(self.file))[-1, 0])

    @property
    def oriented(self) -> bool:
        """Whether the table has orientations."""
        return read_table(Path(self.file)).shape[1] > len(POSITION)

    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """The rows, exactly, and points in between where they are more than `spacing` apart."""
        table = read_table(Path(self.file))
        times = table[:, 0]
        wanted = dense_times(times, spacing)
        turns = None
        if table.shape[1] > len(POSITION):
            turns = turned(times, Rotation.from_quat(table[:, 4:8]), wanted)
        return PathPoints(wanted, through(times, self.scale * table[:, 1:4], wanted), turns)

    def scaled(self, factor: float) -> "CsvPath":
        """The same table with a larger scale."""
        return self.model_copy(update={"scale": factor * self.scale})


def read_table(file: Path) -> Array:
    """Rows (k, 4) t, x, y, z or (k, 8) with qx, qy, qz, qw, in s and m.

    Raises ValueError that names file, line and column for whatever cannot be used.
    """
    if not file.is_file():
        raise ValueError(f"there is no file {file}")
    try:
        with file.open(encoding="utf-8-sig", newline="") as stream:
            rows = csv.reader(stream)
            columns = _columns(file, next(rows, []))
            table = _numbers(file, columns, rows)
    except (OSError, UnicodeDecodeError, csv.Error) as fault:
        raise ValueError(f"{file}: cannot be read: {fault}") from fault
    _check_times(file, table[:, 0])
    _check_values(file, table)
    return table


def _columns(file: Path, header: list[str]) -> list[int]:
    """Where in a line the columns are."""
    names = [name.strip() for name in header]
    wanted = POSITION + (ORIENTATION if set(ORIENTATION) & set(names) else ())
    if sorted(names) != sorted(wanted):
        raise ValueError(
            f"{file}: the header line is {','.join(names)!r}; needed are the columns"
            f" {','.join(POSITION)}, and {','.join(ORIENTATION)} where it has orientations"
        )
    return [names.index(name) for name in wanted]


def _numbers(file: Path, columns: list[int], rows: Any) -> Array:
    table: list[list[float]] = []
    for row in rows:
        if not row:  # an empty line
            continue
        if len(row) != len(columns):
            raise ValueError(
                f"{file}, line {rows.line_num}: {len(row)} values; the header has {len(columns)}"
            )
        if len(table) == MOST_ROWS:
            raise ValueError(f"{file}: more than {MOST_ROWS} rows")
        try:
            table.append([float(row[k]) for k in columns])
        except ValueError as fault:
            raise ValueError(f"{file}, line {rows.line_num}: {fault}") from fault
    if len(table) < 2:
        raise ValueError(f"{file}: a path needs two rows or more, has {len(table)}")
    return np.array(table)


def _check_times(file: Path, times: Array) -> None:
    if times[0] != 0.0:
        raise ValueError(f"{file}: the first time is {times[0]:g} s, must be 0")
    steps = np.diff(times)
    if not np.all(steps > 0.0):
        row = int(np.argmax(~(steps > 0.0)))
        raise ValueError(
            f"{file}: t must increase; it is {times[row + 1]:g} s after {times[row]:g} s"
        )
    if times[-1] > LONGEST_PATH_S:
        raise ValueError(f"{file}: takes {times[-1]:g} s, may take at most {LONGEST_PATH_S:g} s")


def _check_values(file: Path, table: Array) -> None:
    good = np.abs(table[:, 1:4]) <= FARTHEST_M  # not a number is not
    if not good.all():
        row, column = np.argwhere(~good)[0]
        raise ValueError(
            f"{file}: {POSITION[1 + column]} = {table[row, 1 + column]:g} m at t ="
            f" {table[row, 0]:g} s; must be within {FARTHEST_M:g} m of the origin"
        )
    for row, norm in enumerate(np.linalg.norm(table[:, 4:8], axis=1) if table.shape[1] > 4 else ()):
        if not is_unit(norm**2):
            raise ValueError(
                f"{file}: the quaternion at t = {table[row, 0]:g} s has the norm {norm:.4g}, must"
                " be 1"
            )
