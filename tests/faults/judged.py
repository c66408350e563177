"""What the tools say about a log that was damaged, against the figures of the whole one."""

import json

from uvms_analysis.check import check_log
from uvms_analysis.check.text import as_text
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.report.page import write_page
from uvms_analysis.summary import summarise
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare

FIGURES_APART = ("wall_s", "real_time_factor", "log_fault", "check", "missing", "reasons")


def whole_run(folder):
    """The log of four simulated seconds on a path."""
    scenario = load_scenario("manipulation", duration_s=4.0)
    summary = prepare(scenario, str(folder), "lockstep", "uvms simulate").run_simulation()
    assert summary["outcome"] == "completed"
    return folder / "run.mcap"


def figures(path):
    summary = summarise(path, wall_s=0.0)
    return {key: value for key, value in summary.items() if key not in FIGURES_APART}


def judged(path, whole, tmp_path):
    """What the tools say about a log: an error, or a stated fault, or the figures of the whole."""
    try:
        log = RunLog.open(path)
    except LogError:
        return "refused"
    check = check_log(log)
    assert check.verdict in as_text(check)
    json.dumps(check.to_json(), allow_nan=False)
    summary = summarise(log, wall_s=0.0)
    json.dumps(summary)
    page = write_page(tmp_path / "report.html", log, summary).read_text(encoding="utf-8")
    assert f"Outcome: {summary['outcome']}" in page
    if summary["outcome"] == "completed":
        assert check.complete
        assert {k: v for k, v in summary.items() if k not in FIGURES_APART} == whole
        return "same figures"
    assert summary["reasons"]
    assert not check.complete
    return "fault stated"


def count_of(results):
    return ", ".join(f"{results.count(one)} {one}" for one in sorted(set(results)))
