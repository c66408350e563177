"""Tests of faults: the quick ones run with all tests, the long ones under `make faults`.

`make faults` also writes docs/faults.md from what the tests saw.
"""

import os
from pathlib import Path

import pytest

LONG = os.environ.get("UVMS_FAULTS") == "long"
TABLE = os.environ.get("UVMS_FAULTS_TABLE", "")
BEGIN, END = "<!-- table -->", "<!-- end of table -->"
ROWS: list[tuple[str, str, str, str]] = []


def pytest_collection_modifyitems(items):
    """Skip nothing silently: long tests are deselected by their marker alone."""
    if not LONG:
        skip = pytest.mark.skip(reason="long: run with `make faults`")
        for item in items:
            if "long" in item.keywords:
                item.add_marker(skip)


@pytest.fixture
def saw(request):
    """Record what a fault led to: `saw("two graphs on one domain", "both exit 3, named")`."""

    def record(fault: str, outcome: str, cases: str = "1") -> None:
        ROWS.append((request.node.nodeid, fault, cases, outcome))

    return record


def pytest_sessionfinish(session):
    """Write the table where `make faults` asks for it."""
    if not TABLE or not ROWS:
        return
    failed = {r.nodeid for r in session.config.stash.get(REPORTS, []) if r.failed}
    lines = [f"| {f} | {n} | {'**FAILED:** ' if i in failed else ''}{o} |" for i, f, n, o in ROWS]
    page = Path(TABLE)
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    table = "\n".join(["| fault | cases | outcome |", "|---|---|---|", *lines])
    after = rest.split(END)[1]
    page.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")


REPORTS = pytest.StashKey[list]()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    report = yield
    item.config.stash.setdefault(REPORTS, []).append(report)
    return report
