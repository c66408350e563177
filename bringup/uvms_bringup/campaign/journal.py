"""What a campaign has computed so far: one JSON object a line, appended as the runs end.

Its first line says what was begun. A line that was cut off when the campaign was killed is dropped;
its run is made again.
"""

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.row import OF_MACHINE, Row
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
        self._file: int | None = None
        if self.path.exists():
            self._read()

    def _read(self) -> None:
        whole, _, _ = self.path.read_bytes().rpartition(b"\n")
        for number, line in enumerate(whole.split(b"\n") if whole else (), start=1):
            try:
                self._take(number, json.loads(line))
            except (ValueError, KeyError, TypeError) as fault:
                raise CampaignError(self._damaged(number)) from fault

    def _take(self, number: int, values: Any) -> None:
        if number == 1:
            self.head = dict(values)
        else:
            self.rows[values["case"], values["seed"]] = values

    def _damaged(self, number: int) -> str:
        remedy = (
            "it says what the campaign was begun with; begin anew with another --output"
            if number == 1
            else "delete that line, and --resume makes its run again"
        )
        return f"{self.path}: line {number} is damaged: {remedy}"

    def is_made(self, key: tuple[str, int]) -> bool:
        """Whether a run has its result; an error of the machine is none."""
        return key in self.rows and not self.rows[key].get(OF_MACHINE)

    def begin(self, head: Mapping[str, Any]) -> None:
        """Write the first line where there is none, and be ready to append.

        Raises:
            CampaignError: the file cannot be written.
        """
        whole = self.path.read_bytes().rpartition(b"\n")[0] if self.head else b""
        try:
            self._file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o644)
            os.ftruncate(self._file, len(whole) + 1 if self.head else 0)  # a line that was cut off
        except OSError as fault:
            raise CampaignError(self._unwritable(fault)) from fault
        if not self.head:
            self._append(head)
            self.head = dict(head)

    def add(self, row: Row) -> None:
        """One more row; it is in the file when this returns.

        Raises:
            CampaignError: the file cannot be written; what it had before is kept.
        """
        self._append(row)
        self.rows[row["case"], row["seed"]] = row

    def close(self) -> None:
        """No more rows; harmless when repeated."""
        if self._file is not None:
            os.close(self._file)
            self._file = None

    def _append(self, values: Mapping[str, Any]) -> None:
        if self._file is None:
            raise CampaignError(f"{self.path}: is closed")
        line = memoryview(json.dumps(values).encode() + b"\n")
        size = os.fstat(self._file).st_size
        try:
            while line:  # a disk that is nearly full takes a part
                line = line[os.write(self._file, line) :]
        except OSError as fault:
            os.ftruncate(self._file, size)
            raise CampaignError(self._unwritable(fault)) from fault

    def _unwritable(self, fault: OSError) -> str:
        return (
            f"{self.path}: cannot be written: {fault.strerror}; its {len(self.rows)} rows are"
            f" kept: mend the cause, and go on with --resume --output {self.path.parent}"
        )
