"""Paths of a scenario's goal: files beside the scenario, and other arms."""

import numpy as np
import pytest

from uvms_bringup.errors import ScenarioError
from uvms_bringup.scenario import load_scenario

TABLE = "t,x,y,z\n0,0,0,0\n5,0.1,0,0.05\n10,0,0,0.1\n"
SCENARIO = """
duration_s: 12.0
plant: {initial_position_m: [0, 0, 10], initial_posture: home}
goal:
  path_made_for: reference_auv
  path: {csv: %s}
"""


def saved(folder, csv="paths/scan.csv"):
    (folder / "paths").mkdir()
    (folder / "paths" / "scan.csv").write_text(TABLE, encoding="utf-8")
    (folder / "mine.yaml").write_text(SCENARIO % csv, encoding="utf-8")
    return str(folder / "mine.yaml")


@pytest.mark.parametrize("csv", ["paths/scan.csv", "{file: paths/scan.csv}"])
def test_a_table_is_found_beside_the_scenario_that_names_it(tmp_path, monkeypatch, csv):
    name = saved(tmp_path, csv)
    monkeypatch.chdir("/")
    scenario = load_scenario(name)
    assert scenario.goal.path.csv.file == str(tmp_path / "paths" / "scan.csv")
    assert scenario.goal.duration_s == 10.0


def test_on_the_command_line_a_table_is_found_in_the_working_directory(tmp_path, monkeypatch):
    saved(tmp_path)
    monkeypatch.chdir(tmp_path / "paths")
    settings = ["goal.path={csv: scan.csv}", "plant.initial_posture=home"]
    assert load_scenario("manipulation", settings).goal.path.csv.file == str(
        tmp_path / "paths" / "scan.csv"
    )
    with pytest.raises(ScenarioError, match=r"goal\.path\.csv.*there is no file .*/other\.csv"):
        load_scenario("manipulation", ["goal.path={csv: other.csv}"])


def test_another_arm_follows_a_table_scaled_by_its_length(tmp_path):
    name = saved(tmp_path)
    paths = {}
    for vehicle in ("reference_auv", "bluerov2_alpha5"):
        scenario = load_scenario(name, vehicle=vehicle)
        own = scenario.load_vehicle()
        goal = scenario.goal.build(own, scenario.plant)
        paths[vehicle] = goal.positions - goal.positions[0]
        again = scenario.for_vehicle(own)
        assert again.goal.path_made_for is None
        same = again.goal.build(own, scenario.plant).positions
        assert np.allclose(same, goal.positions, atol=1e-12)
    ratio = np.linalg.norm(paths["bluerov2_alpha5"], axis=1)[1:]
    ratio = ratio / np.linalg.norm(paths["reference_auv"], axis=1)[1:]
    assert np.allclose(ratio, ratio[0])
    assert 0.1 < ratio[0] < 0.9
