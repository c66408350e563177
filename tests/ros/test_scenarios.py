"""Every scenario that comes with the product begins on the real graph, its goal accepted."""

import pytest
from graph import finished, uvms_here

from uvms_bringup.scenario import known_scenarios

DURATION = "2"


@pytest.mark.parametrize("name", known_scenarios())
def test_a_shipped_scenario_runs_on_the_graph(name, tmp_path):
    outcome = finished(uvms_here(tmp_path, "run", name, "--duration", DURATION, "--composed"))
    assert outcome.summary["completed"] is True
    assert outcome.summary["sim_duration_s"] == pytest.approx(float(DURATION))
    assert outcome.summary["lockstep_timeouts"] == 0
