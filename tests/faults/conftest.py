"""Tests of faults: the quick ones run with all tests, the long ones under `make faults`.

`make faults` also writes docs/faults.md from what the tests saw.
"""

import os
import re
from collections import defaultdict
from pathlib import Path

import pytest
from judged import figures, whole_run
from outcome_runs import DURATION_S, counters_of_parts, simulated

LONG = os.environ.get("UVMS_FAULTS") == "long"
TABLE = os.environ.get("UVMS_FAULTS_TABLE", "")
BEGIN, END = "<!-- table -->", "<!-- end of table -->"
SEEN: dict[str, list[tuple[str, str, int]]] = defaultdict(list)
"""What each test saw: fault, outcome, number of cases; by the test's node id."""
FAILED: dict[str, str] = {}
"""Why a test failed, in one line, by its node id."""


def pytest_collection_modifyitems(items):
    """Long tests are skipped, and listed as skipped, unless they are asked for."""
    if not LONG:
        skip = pytest.mark.skip(reason="long: run with `make faults`")
        for item in items:
            if "long" in item.keywords:
                item.add_marker(skip)


def _line(text: str) -> str:
    """One line of a table, without the folders of this machine."""
    first = text.strip().splitlines()[0]
    return re.sub(r"/\S*/pytest-\S*/", "", first).replace("|", "/")


@pytest.fixture
def saw(request):
    """Record what a fault led to: `saw("two graphs on one domain", "both exit 3, named")`."""

    def record(fault: str, outcome: str, cases: str | int = 1) -> None:
        SEEN[request.node.nodeid].append((_line(fault), _line(outcome), int(cases)))

    return record


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(item):
    """Note who fails, so that the table shows it."""
    report = yield
    if report.failed:
        FAILED[item.nodeid] = report.longreprtext.strip().splitlines()[-1]
    return report


def pytest_sessionfinish(session):
    """Write the table where `make faults` asks for it, and only where all tests have run."""
    if not TABLE:
        return
    options = session.config.option
    narrowed = options.keyword or options.markexpr or session.config.args != ["tests/faults"]
    if narrowed or session.shouldstop or session.shouldfail:
        print(f"\n{TABLE} is left as it is: only a whole `make faults` writes it")
        return
    page = Path(TABLE)
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    which = "All tests." if LONG else "The quick tests; those that take long were left out."
    table = "\n".join([which, "", "| fault | cases | outcome |", "|---|---|---|", *_rows()])
    page.write_text(f"{before}{BEGIN}\n{table}\n{END}{rest.split(END)[1]}", encoding="utf-8")


def _rows():
    """One for each fault and outcome, then one for each test that failed."""
    counts: dict[tuple[str, str], int] = defaultdict(int)
    for test, rows in SEEN.items():
        for fault, outcome, cases in rows if test not in FAILED else ():
            counts[fault, outcome] += cases
    yield from (f"| {fault} | {n} | {outcome} |" for (fault, outcome), n in counts.items())
    for test, why in FAILED.items():
        yield f"| `{test.rpartition('/')[2]}` | 1 | **failed**: {_line(why)} |"


@pytest.fixture(scope="session")
def run(tmp_path_factory):
    """Six seconds on a path."""
    folder = tmp_path_factory.mktemp("run") / "path"
    path, summary = simulated(folder, "manipulation", duration_s=DURATION_S)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    return path


@pytest.fixture(scope="session")
def uncontrolled(tmp_path_factory):
    """Six seconds in which the arm moves and nobody controls the vehicle."""
    folder = tmp_path_factory.mktemp("run") / "free"
    settings = ("control.enabled=false", "goal.joints.times_s=[5.0]")
    posture = "goal.joints.positions_deg=[[10.0, 5.0, 130.0, 0.0]]"
    path, summary = simulated(folder, "arm_swing", *settings, posture, duration_s=DURATION_S)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    return path


@pytest.fixture(scope="session")
def hover(tmp_path_factory):
    """Forty seconds in which the vehicle holds its pose."""
    folder = tmp_path_factory.mktemp("run") / "hover"
    path, summary = simulated(folder, "hover", duration_s=40.0)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    assert all(counts["refused"] == 0 for counts in counters_of_parts(summary))
    return path


@pytest.fixture(scope="session")
def whole_log(tmp_path_factory):
    """The log that tests damage."""
    return whole_run(tmp_path_factory.mktemp("run") / "whole")


@pytest.fixture(scope="session")
def whole(whole_log):
    """Its figures."""
    return figures(whole_log)


@pytest.fixture(scope="session")
def data(whole_log):
    """Its bytes."""
    return whole_log.read_bytes()
