"""When a path begins, as a log tells it: the tool is compared with its path at the same instant."""

import numpy as np
import pytest

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.read import RunLog
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core.end_effector_path import EndEffectorPath

FAST = "goal.path={circle: {radius_m: 0.3, plane: XOZ, turns: 0.2, period_s: 60, ease_s: 4}}"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A tool at up to 31 mm/s whose vehicle knows where it is."""
    folder = tmp_path_factory.mktemp("runs") / "circle"
    settings = [FAST, "navigation.source=truth"]
    scenario = load_scenario("manipulation", settings, duration_s=20.0)
    summary = prepare(scenario, str(folder), "lockstep", "test").run_simulation()
    return Analysis(RunLog.open(folder / "run.mcap")), summary


def test_the_references_are_on_the_path_at_the_time_since_its_start(run):
    analysis, _ = run
    plan, path = analysis.planned, EndEffectorPath(analysis.path)
    after = plan.time - analysis.path_start_s
    within = (after >= 0.0) & (after <= path.duration)
    off = np.linalg.norm(path.positions(after[within]) - plan.end_effector[within], axis=1)
    speed = np.linalg.norm(np.gradient(plan.end_effector, plan.time, axis=0), axis=1).max()
    assert speed > 0.025
    assert off.max() < 0.1 * speed * 0.5  # a start that is a planner step off shows as 0.5 s


def test_the_tool_is_as_near_as_the_reference_says(run):
    _, summary = run
    assert summary["end_effector_tracking_error_m"]["rms"] < 0.002
