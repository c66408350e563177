"""The navigation filter on the pool trials, and what is said of their inertial unit."""

import dataclasses

import numpy as np
import pytest
from command_line import main
from made_trials import DATA, VEHICLE, made_trial, write_trial

from uvms_analysis.trials.convention import FLIP, quaternion
from uvms_analysis.trials.navigate import navigate, navigated_vehicle
from uvms_analysis.trials.read import INERTIAL, read_trial
from uvms_analysis.trials.unit import attitude_error, force_offset, wandering
from uvms_analysis.trials.validate import navigated
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import quat_to_matrix

SHORT = DATA / "traj026-1.csv"


@pytest.fixture(scope="module")
def trials():
    return [read_trial(file) for file in sorted(DATA.glob("*.csv"))]


def test_the_target_on_the_shipped_trials(trials):
    """Median error 5 mm with the vehicle file's values; every sample of every trial in 3 sigma."""
    found = navigated(str(VEHICLE), trials)
    assert len(found) == 20
    assert np.median(np.concatenate([each.distance for each in found])) <= 0.005
    assert min(each.share_inside for each in found) == 1.0
    assert sum(each.gated for each in found) == 0


def test_a_unit_taken_for_better_than_it_is_shows():
    """The same trial, its unit taken for a tactical one: the filter is wrong, and sure of it."""
    trial = read_trial(SHORT)
    honest = navigated_vehicle(str(VEHICLE), trial)
    tactical = {
        "roll_pitch_bias_deg": 0.02,
        "accelerometer_bias_m_s2": 1e-3,
        "bias_time_constant_s": 600.0,
    }
    imu = honest.sensors.imu.model_copy(update=tactical)
    sensors = honest.sensors.model_copy(update={"imu": imu})
    wrong = navigate(trial, honest.model_copy(update={"sensors": sensors}))
    right = navigate(trial, honest)
    assert wrong.share_inside < 0.8
    assert np.median(right.distance) < 0.2 * np.median(wrong.distance)


def test_only_the_first_moments_align_the_heading():
    """A heading of the motion capture that turns later on changes nothing of the estimate."""
    trial = read_trial(SHORT)
    vehicle = navigated_vehicle(str(VEHICLE), trial)
    turned = trial.attitude.copy()
    turned[trial.t > trial.t[0] + 0.6, 2] += 30.0
    other = dataclasses.replace(trial, attitude=turned)
    np.testing.assert_array_equal(navigate(trial, vehicle).error, navigate(other, vehicle).error)


def with_unit(trial, error_deg, bias):
    """The trial with a unit whose attitude is off by error (k, 3), its force by bias (3,)."""
    attitude = trial.attitude + error_deg
    up = -np.array([quat_to_matrix(quaternion(each))[2] for each in attitude])
    force = (9.81 * up + bias) * FLIP
    return dataclasses.replace(trial, inertial=np.hstack([attitude, force]))


def test_a_steady_drift_wanders_by_its_rate():
    trial = made_trial(load_vehicle(VEHICLE), 1)
    rate = np.array([0.05, -0.02, 0.2])
    unit = with_unit(trial, np.outer(trial.t, rate), np.zeros(3))
    found = wandering([unit], [attitude_error(unit)], 5.0)
    np.testing.assert_allclose(found, np.abs(rate) * 5.0 / np.sqrt(2.0), rtol=1e-9)


def test_a_bias_of_the_force_is_found():
    """To first order: a bias also changes the length, by which gravity is known."""
    unit = with_unit(made_trial(load_vehicle(VEHICLE), 2), np.zeros(3), np.array([0.03, -0.1, 0.0]))
    np.testing.assert_allclose(force_offset(unit), [0.03, -0.1, 0.0], atol=0.02)


def test_trials_without_a_unit_are_named(tmp_path, capsys):
    """Its columns are optional; what is left out is said, and the rest goes on."""
    write_trial(made_trial(load_vehicle(VEHICLE), 1), tmp_path)
    assert main(["validate", str(tmp_path), "--vehicle", str(VEHICLE)]) == 0
    printed = capsys.readouterr()
    assert "navigation is left out in 1 of 1 trials: they lack one of the columns" in printed.err
    assert ", ".join(INERTIAL) in printed.err
    assert "in 3 sigma" not in printed.out
    (tmp_path / "real.csv").write_text(SHORT.read_text(encoding="utf-8"), encoding="utf-8")
    assert main(["validate", str(tmp_path), "--vehicle", str(VEHICLE)]) == 0
    printed = capsys.readouterr()
    assert "left out in 1 of 2 trials" in printed.err
    assert "all 1 " in printed.out
    assert "1st, 3rd ... specific force" in printed.out
