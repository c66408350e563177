"""The sensor of an external package on the real graph: plant, navigation, recorder, replay."""

import pytest
from added_sensor import SECTION, installed, uvms, vehicle_file
from graph import own_domain

from uvms_analysis.log.compare import compare
from uvms_analysis.log.read import RunLog
from uvms_core import topics

RUN = ("hover", "--duration", "4", "--seed", "3")


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    python_path = installed(tmp_path_factory.mktemp("installed"))["PYTHONPATH"]
    return own_domain() | {"PYTHONPATH": python_path}


@pytest.fixture(scope="module")
def folders(tmp_path_factory, environment):
    """One run in process and one on the graph."""
    made = []
    for options in (("simulate",), ("run", "--composed")):
        folder = tmp_path_factory.mktemp(options[0])
        vehicle = vehicle_file(folder, 0.1, usbl=SECTION)
        command, *flags = options
        settings = ("--set", f"vehicle={vehicle}", "--output", folder)
        done = uvms(environment, command, *RUN, *flags, *settings)
        assert done.returncode == 0, done.stderr
        made.append(folder)
    return made


def test_graph_and_simulation_agree_with_its_fixes(folders):
    simulated, graph = (RunLog.open(folder / "run.mcap") for folder in folders)
    fixes = [list(log.raw(["/sensors/usbl"])) for log in (simulated, graph)]
    assert fixes[0] == fixes[1]
    assert len(fixes[0]) == 5
    for difference in compare(simulated, graph, [topics.ODOMETRY, topics.THRUSTER_COMMAND]):
        assert difference.greatest < 1e-9, difference
    status = graph.statuses("navigation")[-1]
    assert float(status.values["usbl_accepted"]) >= 4


def test_navigation_is_replayed_with_its_fixes(folders, environment, tmp_path):
    log = folders[1] / "run.mcap"
    done = uvms(environment, "replay", log, "--into", "navigation", "--output", tmp_path)
    assert done.returncode == 0, done.stderr
    run, replayed = RunLog.open(log), RunLog.open(tmp_path / "replay.mcap")
    (difference,) = compare(run, replayed, [topics.ODOMETRY])
    assert difference.common == difference.recorded == difference.replayed > 0
    assert difference.greatest == 0.0
