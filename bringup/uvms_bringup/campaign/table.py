"""The table of results, `results.parquet`: one row a run, one column a field."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.row import Row
from uvms_bringup.errors import CampaignError

TABLE_FILE = "results.parquet"


def write_table(path: Path, rows: Sequence[Row]) -> None:
    """Write rows; a column has one type: number, whole number, truth value, text or texts."""
    import pyarrow
    from pyarrow import parquet

    names = list(dict.fromkeys(name for row in rows for name in row))
    columns = {}
    for name in names:
        kind, values = _column([row.get(name) for row in rows])
        columns[name] = pyarrow.array(values, getattr(pyarrow, kind)() if kind else _texts())
    partial = path.with_name(f".{path.name}.partial")
    parquet.write_table(pyarrow.table(columns), partial)
    partial.replace(path)  # a reader never sees half a table


def read_table(path: Path) -> list[Row]:
    """The rows of a table.

    Raises:
        CampaignError: the file cannot be read.
    """
    import pyarrow
    from pyarrow import parquet

    try:
        return parquet.read_table(path).to_pylist()
    except (OSError, pyarrow.ArrowException) as fault:
        raise CampaignError(f"{path}: cannot be read: {fault}") from fault


def _texts() -> Any:
    import pyarrow

    return pyarrow.list_(pyarrow.string())


def _column(values: list[Any]) -> tuple[str, list[Any]]:
    """Name of the type of a column ("" for lists of texts), and its values in it."""
    kinds = {_kind(value) for value in values if value is not None}
    if kinds == {bool}:
        return "bool_", values
    if kinds == {int}:
        return "int64", values
    if kinds and kinds <= {int, float}:
        return "float64", [None if value is None else float(value) for value in values]
    if kinds == {list}:
        return "", values
    return "string", [None if value is None else _text(value) for value in values]


def _kind(value: Any) -> type:
    if isinstance(value, list) and all(isinstance(one, str) for one in value):
        return list
    return type(value) if isinstance(value, bool | int | float) else str


def _text(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(value)
