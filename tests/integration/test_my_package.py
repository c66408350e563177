"""A package from outside brings a control law and a planner method into the in-process loop."""

import json
import re

import numpy as np
import pytest
from example_package import SOURCE, installed, uvms

from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, mass_matrix, restoring_wrench

STEP = 10


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    return installed(tmp_path_factory.mktemp("my_package"))


def run(site, folder, *arguments):
    """`uvms simulate ...` to its end; returns its summary and its log."""
    done = uvms(site, "simulate", *arguments, "--output", str(folder))
    assert done.returncode == 0, done.stderr
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["completed"] is True
    return summary, RunLog.open(folder / "run.mcap")


def expected_wrenches(log: RunLog, bandwidth: float) -> np.ndarray:
    """M (w^2 e + 2 w e_dot) less the restoring wrench, about the first pose, held level.

    For small angles, with the formulas of a level vehicle: the attitude error is (-roll, -pitch,
    heading error).
    """
    model = build_model(load_vehicle())
    odometry = log.series(topics.ODOMETRY)
    joints = log.series(topics.JOINT_STATES)
    rows = []
    for position, quaternion, nu, q in zip(
        odometry.position, odometry.quaternion, odometry.nu, joints.position, strict=True
    ):
        R_world_body = rotation(quaternion)
        R_world_level = heading(odometry.quaternion[0])
        turn = R_world_body.T @ R_world_level
        angle = 0.5 * np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        angle -= 0.5 * np.array([turn[1, 2], turn[2, 0], turn[0, 1]])
        error = np.concatenate((R_world_body.T @ (odometry.position[0] - position), angle))
        acceleration = bandwidth**2 * error - 2.0 * bandwidth * nu
        weight = restoring_wrench(model, quaternion, q)
        rows.append(mass_matrix(model, q)[:6, :6] @ acceleration - weight)
    return np.array(rows)


def rotation(quaternion) -> np.ndarray:
    x, y, z, w = quaternion
    v = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * w * v + 2.0 * v @ v


def heading(quaternion) -> np.ndarray:
    R = rotation(quaternion)
    c, s = R[0, 0], R[1, 0]
    size = np.hypot(c, s)
    return np.array([[c / size, -s / size, 0.0], [s / size, c / size, 0.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize("law", ["my_law", "my_package.my_law:MyLaw"])
def test_the_control_law_steers_the_vehicle(law, site, tmp_path):
    settings = ("--set", f"control.law={law}", "--set", "control.parameters.bandwidth=0.7")
    summary, log = run(site, tmp_path, "hover", "--duration", "5", *settings)
    commanded = log.series(topics.WRENCH_COMMAND).wrench
    expected = expected_wrenches(log, 0.7)
    assert commanded.shape == expected.shape == (101, 6)
    assert np.abs(expected[:, :3]).max() > 1.0
    np.testing.assert_allclose(commanded, expected, atol=1e-3 * np.abs(expected).max())
    assert summary["vehicle_error_m"]["max"] < 0.05
    control = log.configuration()["control"]
    assert control["law"] == law
    assert control["parameters"] == {"bandwidth": 0.7, "arm_bandwidth": 6.0, "damping_ratio": 1.0}


def test_a_run_with_the_law_has_a_report_as_any_other(site, tmp_path):
    summary, _ = run(site, tmp_path, "arm_swing", "--duration", "12", "--set", "control.law=my_law")
    assert summary["end_effector_error_m"]["max"] < 0.15
    assert summary["roll_deg"]["max"] < 8.0
    done = uvms(site, "report", str(tmp_path / "run.mcap"))
    assert done.returncode == 0, done.stderr
    assert next(tmp_path.rglob("*.html")).stat().st_size > 10_000


@pytest.mark.parametrize("method", ["my_method", "my_package.my_method:MyMethod"])
def test_the_planner_method_follows_the_path(method, site, tmp_path):
    settings = ("--set", f"planner.method={method}")
    _, log = run(site, tmp_path, "manipulation", "--duration", "20", *settings)
    steps = [
        status.values
        for status in log.signals(topics.DIAGNOSTICS)
        if status.name == "motion_planner" and "method" in status.values
    ]
    assert len(steps) > STEP
    assert {step["method"] for step in steps} == {method}
    joined = steps[len(steps) // 2 + 2 :]  # the plan takes 10 s to join the path
    assert max(float(step["planned_error_m"]) for step in joined) < 1e-3
    assert {step["evaluations"] for step in steps} == {"1"}  # the genetic method needs hundreds


def test_a_parameter_out_of_bounds_is_named_before_the_run(site, tmp_path):
    folder = tmp_path / "run"
    settings = ("--set", "control.law=my_law", "--set", "control.parameters.bandwidth=-1")
    done = uvms(site, "simulate", "hover", *settings, "--output", str(folder))
    assert done.returncode == 2
    assert "parameters of control law 'my_law': bandwidth" in done.stderr
    assert "greater than 0" in done.stderr
    assert "Traceback" not in done.stderr
    assert not folder.exists()


def test_the_readme_names_what_is_there():
    text = (SOURCE / "README.md").read_text(encoding="utf-8")
    for path in re.findall(r"`(my_package/\w+\.py)`", text):
        assert (SOURCE / path).is_file()
