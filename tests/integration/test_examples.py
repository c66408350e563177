"""Every example runs as a user would run it, and prints what it promises."""

import re
import subprocess
import sys
from functools import cache
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).resolve().parents[2] / "examples"
SCRIPTS = sorted(FOLDER.glob("*.py"))


@pytest.fixture(scope="module")
def output(tmp_path_factory):
    """What an example prints; each runs once, in an empty folder that it must leave empty."""

    @cache
    def run(script):
        folder = tmp_path_factory.mktemp(script.stem)
        done = subprocess.run(
            [sys.executable, str(script)],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=300,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        assert list(folder.iterdir()) == []
        return done.stdout.splitlines()

    return run


def numbers(line):
    return [float(text) for text in re.findall(r"-?\d+\.\d+", line)]


def test_there_is_one_for_each_package():
    packages = {"core", "dynamics", "planner", "control", "observer", "analysis", "bringup"}
    assert packages <= {script.stem.split("_")[0] for script in SCRIPTS}


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda path: path.stem)
def test_example_runs_without_ros(script, output):
    text = script.read_text(encoding="utf-8")
    assert f"python examples/{script.name}" in text.split('"""')[1]
    assert not re.search(r"^(import|from) (rclpy|\w+_msgs)", text, re.MULTILINE)
    assert len(output(script)) >= 2


def test_free_vehicle_heels_over_and_comes_to_rest(output):
    rows = [numbers(line) for line in output(FOLDER / "dynamics_free_roll.py")[2:-2]]
    _, swing, roll, _, energy, moment = rows[-1]
    assert 58.0 < swing < 64.0
    assert 10.0 < roll < 30.0
    assert energy < 0.1 * max(row[4] for row in rows)
    assert abs(moment) < 0.02


def test_own_chain_inverts_its_own_dynamics(output):
    vehicle, joints, needed, masses = map(numbers, output(FOLDER / "dynamics_own_chain.py"))
    assert np.abs(vehicle + joints).max() > 1.0
    np.testing.assert_allclose(needed, [0.0] * 6 + [3.0, 1.0], atol=1e-3)
    water = 1025.0 * np.pi / 6.0 * 1.2 * 0.4**2  # displaced by the hull, kg
    assert water < masses[0] < masses[1] < 2.5 * water
    assert len(masses) == 8


def test_runs_over_time_roll_to_where_the_arm_goes(output):
    *_, last, many = map(numbers, output(FOLDER / "dynamics_over_time.py"))
    swing, roll = last[1:3]
    assert 30.0 < swing < 119.0  # on its way, not at the stop
    low, high = many
    assert 0.0 < low < roll < high < low + 5.0


def test_genetic_plan_disturbs_less_than_the_arm_alone(output):
    ends = [
        numbers(line)[-1]
        for line in output(FOLDER / "planner_path.py")
        if "end of the goal is reached" in line
    ]
    arm_only, genetic = ends
    assert genetic < 0.5 * arm_only


def test_own_controller_takes_the_place_of_ours(output):
    ours, own = map(numbers, output(FOLDER / "own_controller.py"))
    assert ours[0] < 5.0 < own[0] < 25.0


def test_vehicle_file_with_its_changes_becomes_a_urdf(output):
    lines = output(FOLDER / "core_vehicle.py")
    masses = {line.split()[0]: numbers(line)[0] for line in lines[3:8]}
    assert masses["hull"] == 190.0
    assert masses["gripper"] == 0.8
    assert lines[-1] == "of these move: swing, shoulder, elbow, wrist"


def test_own_log_is_summarised_and_lacks_what_was_not_written(output):
    lines = output(FOLDER / "analysis_summary.py")
    start, end = numbers(lines[1].split(":")[1])
    assert start == 10.0
    assert 12.0 < end < 15.0  # of a vehicle 8.5 kg too heavy, after 10 s
    assert all(value > 0.0 for line in lines[2:5] for value in numbers(line))
    assert lines[5] == "navigation_error_m: {'rms': None, 'max': None, 'end': None}"
