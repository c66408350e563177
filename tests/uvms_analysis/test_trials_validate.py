"""The model against the pool trials, and what the command writes."""

import dataclasses

import numpy as np
import pytest
from command_line import main
from made_trials import DATA, VEHICLE, body_matrix, made_trial, write_trial

from uvms_analysis.trials import convention
from uvms_analysis.trials.motion import joint_motion
from uvms_analysis.trials.predict import drive_model, dynamic, prepare_trial
from uvms_analysis.trials.read import read_trial
from uvms_analysis.trials.score import medians, scores
from uvms_analysis.trials.sensor import sensor_tilts
from uvms_analysis.trials.validate import DYNAMIC, QUASI_STATIC, outcomes, table
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import quat_to_matrix

SHORT = DATA / "traj026-1.csv"


@pytest.fixture(scope="module")
def vehicle():
    return load_vehicle(VEHICLE)


def columns(file):
    header = file.read_text(encoding="utf-8").splitlines()[0].split(",")
    return dict(zip(header, np.loadtxt(file, delimiter=",", skiprows=1).T, strict=True))


def test_the_target_on_the_shipped_trials(vehicle):
    """Pitch 0.55 deg, roll 0.58 deg, median over the trials; better than the balance alone."""
    found = table(list(outcomes(vehicle, read_all())))
    roll, pitch = medians(found[DYNAMIC])
    assert pitch.rmse <= 0.55
    assert roll.rmse <= 0.58
    still_roll, still_pitch = medians(found[QUASI_STATIC])
    assert roll.rmse < still_roll.rmse
    assert pitch.rmse < still_pitch.rmse


def read_all():
    return [read_trial(file) for file in sorted(DATA.glob("*.csv"))]


def test_attitudes_go_over_to_ours():
    """R_ours = F R_trials F with F = diag(1, -1, -1), against the file's own quaternion."""
    data, flip = columns(SHORT), np.diag(convention.FLIP)
    for k in (0, 100, 200):
        theirs = body_matrix([data[name][k] for name in ("qw", "qx", "qy", "qz")])
        angles = np.array([data[name][k] for name in ("roll", "pitch", "yaw")])
        ours = quat_to_matrix(convention.quaternion(angles))
        np.testing.assert_allclose(ours, flip @ theirs @ flip, atol=2e-4)
        np.testing.assert_allclose(convention.tilt_deg(ours[2]), angles[:2], atol=1e-9)
        np.testing.assert_allclose(convention.down_direction(angles[:2]), ours[2], atol=1e-12)


def test_the_spline_has_the_measured_rates():
    trial, data = read_trial(SHORT), columns(SHORT)
    motion, index = joint_motion(trial)
    rates = np.stack([data[f"dq_{axis}"] for axis in "edcb"], axis=1)
    assert np.abs(motion.q_dot[2 * index] - rates).max() < 0.2
    assert np.sqrt(np.mean((motion.q_dot[2 * index] - rates) ** 2)) < 0.03
    off = motion.q[2 * index] - convention.joint_angles(trial.alpha)
    assert np.sqrt(np.mean(off**2)) < 0.005


def test_a_gap_is_cut_into_steps():
    trial = read_trial(SHORT)
    kept = np.r_[0:100, 110 : len(trial.t)]
    gappy = dataclasses.replace(
        trial, **{f.name: getattr(trial, f.name)[kept] for f in dataclasses.fields(trial)[1:]}
    )
    motion, index = joint_motion(gappy)
    assert motion.steps.max() <= 0.05 + 1e-12
    assert motion.steps.sum() == pytest.approx(trial.t[-1] - trial.t[0])
    np.testing.assert_allclose(trial.t[0] + np.append(0, np.cumsum(motion.steps))[index], gappy.t)


def test_only_the_initial_state_is_looked_at(vehicle):
    """Whatever happens to the attitude after the first half second, the prediction is the same."""
    trial, drive = read_trial(SHORT), drive_model(vehicle)
    later = trial.t > trial.t[0] + 0.5
    other = trial.attitude.copy(), trial.position.copy(), trial.gyro.copy()
    for values in other:
        values[later] += np.random.default_rng(1).normal(size=values[later].shape)
    changed = dataclasses.replace(trial, attitude=other[0], position=other[1], gyro=other[2])
    expected = dynamic(prepare_trial(trial), *drive).tilt
    np.testing.assert_array_equal(dynamic(prepare_trial(changed), *drive).tilt, expected)
    measured = trial.tilt[~later & trial.accepted].mean(axis=0)
    np.testing.assert_allclose(expected[0], measured, atol=1e-6)


def test_the_model_predicts_what_it_made(vehicle):
    """From rest, with the same constants, nothing is left but the smoothing of the joints."""
    trial = made_trial(vehicle, 3)
    predicted = dynamic(prepare_trial(trial), *drive_model(vehicle))
    assert np.abs(trial.tilt - trial.tilt[0]).max() > 1.0
    np.testing.assert_allclose(predicted.tilt, trial.tilt, atol=0.02)


def test_scores_by_hand(vehicle):
    trial = made_trial(vehicle, 3)
    predicted = trial.tilt + [0.3, 0.0] + np.outer(np.sin(trial.t), [0.0, 0.0])
    roll, pitch = scores(trial, predicted)
    assert roll == pytest.approx((0.3, 0.0, 1.0), abs=1e-9)
    assert pitch == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)
    held = np.full_like(predicted, 2.0)
    assert np.isnan(scores(trial, held)[0].correlation)
    unscored = dataclasses.replace(trial, accepted=trial.t < 10.0)
    predicted[trial.t >= 10.0] += 50.0
    assert scores(unscored, predicted)[0].rmse == pytest.approx(0.3)


class TestCommand:
    """`uvms validate`."""

    def test_files(self, tmp_path, capsys, vehicle):
        trials = tmp_path / "trials"
        trials.mkdir()
        for seed in (1, 2):
            write_trial(made_trial(vehicle, seed), trials)
        output = tmp_path / "deep" / "out"
        arguments = ["validate", str(trials), "--vehicle", str(VEHICLE), "--output", str(output)]
        assert main([*arguments, "--figures"]) == 0
        printed = capsys.readouterr().out
        assert printed.count("median of 2") == 6
        assert printed.count("made1") == 6
        assert (output / "table.txt").read_text(encoding="utf-8") == printed
        predicted = columns(output / "made2.csv")
        assert list(predicted) == ["t", "roll", "pitch"]
        trial = read_trial(trials / "made2.csv")
        np.testing.assert_allclose(predicted["t"], trial.t)
        np.testing.assert_allclose(predicted["pitch"], trial.tilt[:, 1], atol=0.03)
        assert sorted(file.name for file in output.glob("*.png")) == [
            "trials_pitch.png",
            "trials_rmse.png",
            "trials_roll.png",
        ]

    @pytest.mark.parametrize(
        ("options", "text"),
        [
            (["nowhere", "--vehicle", str(VEHICLE)], "nowhere: no such folder"),
            ([str(DATA), "--vehicle", "none.yaml"], "none.yaml: cannot be read"),
            ([str(DATA), "--vehicle", str(VEHICLE), "--figures"], "--figures needs --output DIR"),
        ],
    )
    def test_errors(self, capsys, options, text):
        assert main(["validate", *options]) == 2
        assert capsys.readouterr().err.startswith(f"error: {text}")

    def test_another_arm(self, capsys, tmp_path):
        from test_trials_identify import with_three_joints

        file = with_three_joints(tmp_path)
        assert main(["validate", str(DATA), "--vehicle", str(file)]) == 2
        printed = capsys.readouterr().err
        assert (
            "has 3 joints: base, shoulder, elbow; the trials' arm has 4: base, shoulder" in printed
        )
        assert main(["validate", str(DATA), "--vehicle", "reference_auv"]) == 2
        printed = capsys.readouterr().err
        assert "4 joints: swing, shoulder, elbow, wrist; the trials' arm has 4: base" in printed

    def test_a_vehicle_that_is_another(self, tmp_path, capsys, vehicle):
        """Ballast moved: the table's end says that the file does not describe the trials."""
        write_trial(made_trial(vehicle, 1), tmp_path)
        other = tmp_path / "other.yaml"
        text = VEHICLE.read_text(encoding="utf-8")
        other.write_text(text.replace("cb_m: [0.007608,", "cb_m: [0.037608,"), encoding="utf-8")
        assert main(["validate", str(tmp_path), "--vehicle", str(other)]) == 0
        assert "predicts pitch worse than `constant`" in capsys.readouterr().out
        assert main(["validate", str(tmp_path), "--vehicle", str(VEHICLE)]) == 0
        printed = capsys.readouterr().out
        assert "worse" not in printed
        assert "no offset: the same after" in printed
        assert "attitude sensor" not in printed


def test_no_trim_starts_from_the_models_own_rest(vehicle):
    """With ballast unknown to the file, only the trim keeps the vehicle where it floats."""
    trial, drive = made_trial(vehicle, 3, arm=False), drive_model(vehicle)
    tilted = dataclasses.replace(trial, attitude=trial.attitude + [0.0, 1.0, 0.0])
    held, free = (dynamic(prepare_trial(tilted), *drive, trim) for trim in (True, False))
    still = tilted.t < 1.0
    assert np.abs(held.tilt - tilted.tilt)[still].max() < 0.1
    assert np.abs(free.tilt - tilted.tilt)[still].max() > 0.3


def test_the_sensor_in_the_models_place(vehicle):
    """One offset for all: trials off by 1.2 and 0.8 deg are 0.2 deg off their mean."""
    first, second = (
        dataclasses.replace(trial, sensor=trial.tilt + [off, 0.0])
        for trial, off in ((made_trial(vehicle, 1), 1.2), (made_trial(vehicle, 2), 0.8))
    )
    tilts = sensor_tilts([first, second])
    assert scores(first, tilts[0])[0][:2] == pytest.approx((0.2, 0.0), abs=1e-9)
    assert scores(second, tilts[1])[0][:2] == pytest.approx((0.2, 0.0), abs=1e-9)
    assert sensor_tilts([first, made_trial(vehicle, 2)]) is None
