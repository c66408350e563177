"""Least clearances of a run from its log, where arm and place are known beforehand."""

import numpy as np
import pytest
from synthetic import ARM, Known, write_log

from uvms_analysis.clearance import run_geometry
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.report.plots.attitude import clearance
from uvms_analysis.report.posture import OBSTACLE, obstacle_shapes
from uvms_analysis.report.raycast import Camera, render
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.summary import summarise
from uvms_core.scene import Obstacle
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.geometry import build_geometry, clearances

KNOWN = Known(duration=6.0, path_duration=4.0)
SHEET = """
obstacles:
  - {name: sheet, box: {center_m: [0.0, 2.0, 10.0], size_m: [20.0, 2.0, 20.0]}}
"""


def with_configuration(source, target, extra):
    """A copy of a log whose configuration says more."""
    log = RunLog.open(source)
    with LogWriter(target) as copy:
        copy.attach("config.yaml", log.text("config.yaml") + extra)
        copy.attach("vehicle.yaml", log.text("vehicle.yaml"))
    return RunLog.open(target)


@pytest.fixture(scope="module")
def log_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "run.mcap"
    write_log(path, KNOWN)
    return path


def test_the_arm_at_rest_is_as_clear_as_its_posture(log_file):
    """Its last joint alone turns, about the gripper's own axis."""
    geometry = build_geometry(load_vehicle())
    there = clearances(geometry, np.array([0.0, 0.0, 10.0, 0.0, *ARM]))
    found = summarise(log_file, wall_s=1.0)["clearance_m"]
    assert found["min"] == pytest.approx(there.min(), abs=1e-9)
    assert found["pair"] == str(geometry.pairs[int(np.argmin(there))])
    assert found["planned"]["min"] == pytest.approx(there.min(), abs=1e-9)
    assert 0.0 <= found["at_s"] <= KNOWN.duration


def test_obstacles_of_the_run_count(log_file, tmp_path):
    log = with_configuration(log_file, tmp_path / "run.mcap", SHEET)
    geometry = run_geometry(log)
    assert "hull and sheet" in map(str, geometry.pairs)


def test_a_damaged_scene_is_said_and_the_rest_stays(log_file, tmp_path):
    path = tmp_path / "run.mcap"
    with_configuration(log_file, path, "obstacles: [{name: it}]\n")
    summary = summarise(path, wall_s=1.0)
    assert summary["clearance_m"]["min"] is None
    assert "one of sphere, box" in summary["missing"]["clearance_m"]


def test_the_plot_has_the_pairs_that_come_closest(log_file):
    geometry = build_geometry(load_vehicle())
    there = clearances(geometry, np.array([0.0, 0.0, 10.0, 0.0, *ARM]))
    (panel,) = clearance(ReportedRun("one", RunLog.open(log_file), {}))
    lines = {line.name: line.values for line in panel.lines}
    assert "upper_arm and hull" in lines
    assert lines["least, true"] == pytest.approx(there.min(), abs=1e-9)
    assert lines["least, planned"] == pytest.approx(there.min(), abs=1e-9)


def test_a_box_is_seen_as_its_outline():
    """From 10 m south a cube of 2 m shows its near face, 9 m off, lit from above on none of it."""
    cube = Obstacle(name="it", box={"center_m": [0, 0, 0], "size_m": [2, 2, 2]})
    axes = np.array([[0, 0, -1], [1, 0, 0], [0, -1, 0]]) * 1.0
    camera = Camera(np.array([-10.0, 0.0, 0.0]), axes, 1000.0, (400, 400))
    layer = render(obstacle_shapes([cube]), camera, np.array([0.0, 0.0, -1.0]))
    rows, columns = np.nonzero(np.isfinite(layer.depth))
    assert np.ptp(rows) + 1 == pytest.approx(2000.0 / 9.0, abs=2)
    assert np.ptp(columns) + 1 == pytest.approx(2000.0 / 9.0, abs=2)
    assert layer.depth[200, 200] == pytest.approx(9.0)
    assert layer.colour[200, 200] == pytest.approx(0.52 * np.array(OBSTACLE), abs=1e-3)


def test_without_a_configuration_arm_and_hull_still_count(log_file, tmp_path):
    log = RunLog.open(log_file)
    path = tmp_path / "run.mcap"
    with LogWriter(path) as copy:
        copy.attach("vehicle.yaml", log.text("vehicle.yaml"))
    assert {pair.kind for pair in run_geometry(RunLog.open(path)).pairs} == {"hull", "arm"}
