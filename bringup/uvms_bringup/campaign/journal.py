"""What a campaign has computed so far: one JSON object a line, appended as the runs end.

Its first line says what was begun. A line that was cut off when the campaign was killed is dropped;
its run is made again.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TextIO

from uvms_bringup.campaign.row import Row
from uvms_bringup.errors import CampaignError

JOURNAL_FILE = "rows.jsonl"


class Journal:
    """The rows in a folder, by case and seed.

    Raises:
        CampaignError: the file is not a journal.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / JOURNAL_FILE
        self.head: dict[str, Any] = {}
        self.rows: dict[tuple[str, int], Row] = {}
        self._file: TextIO | None = None
        if self.path.exists():
            self._read()

    def _read(self) -> None:
        whole, _, _ = self.path.read_bytes().rpartition(b"\n")
        lines = whole.splitlines()
        try:
            found = [json.loads(line) for line in lines]
            self.head = found[0] if found else {}
            self.rows = {(row["case"], row["seed"]): row for row in found[1:]}
        except (ValueError, KeyError, TypeError) as fault:
            raise CampaignError(f"{self.path}: is damaged: {fault!r}") from fault

    def begin(self, head: Mapping[str, Any]) -> None:
        """Write the first line where there is none, and be ready to append."""
        if self.head:
            whole, _, torn = self.path.read_bytes().rpartition(b"\n")
            if torn:
                with self.path.open("rb+") as file:
                    file.truncate(len(whole) + 1)
        self._file = self.path.open("a" if self.head else "w", encoding="utf-8")
        if not self.head:
            self.head = dict(head)
            self._append(self.head)

    def add(self, row: Row) -> None:
        """One more row; it is in the file when this returns."""
        self.rows[row["case"], row["seed"]] = row
        self._append(row)

    def close(self) -> None:
        """No more rows; harmless when repeated."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _append(self, values: Mapping[str, Any]) -> None:
        if self._file is None:
            raise CampaignError(f"{self.path}: is closed")
        self._file.write(json.dumps(values) + "\n")
        self._file.flush()
