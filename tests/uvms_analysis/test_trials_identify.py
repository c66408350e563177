"""Identification: known constants are found again, and what does not show is not fitted."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from command_line import main
from made_trials import DATA, VEHICLE, made_trial, write_trial

from uvms_analysis.errors import TrialError
from uvms_analysis.trials import identify as identify_module
from uvms_analysis.trials.fit import fit, group_of
from uvms_analysis.trials.identify import Identified, identify, prepared_trials, report
from uvms_analysis.trials.parameters import CANDIDATES, changed, present, value_at
from uvms_analysis.trials.predict import drive_model, dynamic, prepare_trial
from uvms_analysis.trials.rewrite import rewritten
from uvms_analysis.trials.score import scores
from uvms_core.vehicle import load_vehicle, vehicle_from_data

STATIC = ("hull.cb_m.0", "hull.cb_m.1", "hull.cb_m.2")


@pytest.fixture(scope="module")
def data():
    return yaml.safe_load(VEHICLE.read_text(encoding="utf-8"))


def with_three_joints(folder: Path) -> Path:
    data = yaml.safe_load(VEHICLE.read_text(encoding="utf-8"))
    for name in ("joints", "links", "stowed_deg"):
        del data["arm"][name][-1]
    del data["arm"]["postures_deg"]
    file = folder / "three.yaml"
    file.write_text(yaml.safe_dump(data), encoding="utf-8")
    return file


def chosen(data, *paths):
    return [p for p in present(data)[0] if p.path in paths]


def test_the_repository_carries_what_the_trials_give(data):
    """All that the file marks as identified, from values far off, to a fifth of an error."""
    identified = (
        *STATIC,
        "hull.volume_m3",
        "arm.base.rpy_deg.2",
        "tether.moment_per_m_nm.0",
        "hull.linear_damping.3",
        "hull.linear_damping.4",
        "hull.added_mass.3",
        "hull.added_mass.4",
    )
    parameters = chosen(data, *identified)
    assert len(parameters) == len(identified)
    off = {p.path: value_at(data, p.path) + p.scale * 0.5 for p in parameters}
    found = fit(changed(data, off), prepared_trials(str(DATA)), parameters)
    shipped = np.array([value_at(data, p.path) for p in parameters])
    assert (np.abs(found.values - shipped) < 0.2 * found.errors).all()
    assert (found.errors < [p.worst_error for p in parameters]).all()


@pytest.fixture(scope="module")
def made(data):
    """Eight trials of a vehicle whose constants are not the file's."""
    truth = changed(
        data,
        {
            "hull.cb_m.0": 0.0065,
            "hull.cb_m.1": 0.001,
            "hull.cb_m.2": -0.026,
            "hull.linear_damping.3": 0.35,
            "hull.linear_damping.4": 0.40,
            "hull.added_mass.3": 0.20,
            "hull.added_mass.4": 0.25,
            "arm.base.rpy_deg.2": 3.0,
        },
    )
    vehicle = vehicle_from_data(truth)
    return truth, [made_trial(vehicle, seed, noise_deg=0.05) for seed in range(8)]


def test_known_constants_are_found_again(data, made):
    truth, trials = made
    found = identify(data, [prepare_trial(trial) for trial in trials])
    for parameter, value, error in zip(
        found.fit.parameters, found.fit.values, found.fit.errors, strict=True
    ):
        close = max(4.0 * error, 0.15 * parameter.worst_error)
        assert abs(value - value_at(truth, parameter.path)) < close
        assert 0.0 < error <= parameter.worst_error
    fitted = {parameter.path for parameter in found.fit.parameters}
    assert fitted >= {*STATIC, "hull.added_mass.3", "hull.added_mass.4", "arm.base.rpy_deg.2"}
    assert "quadratic pitch damping" in found.refused
    assert "not fitted: quadratic pitch damping: " in report(found)
    assert found.fit.rms_deg < 0.1


def test_the_report_says_how_many_motions_the_errors_rest_on(data, made):
    prepared = [prepare_trial(trial) for trial in made[1]]
    few, many = (
        fit(data, part, chosen(data, *STATIC), precision=1e-3) for part in (prepared[:4], prepared)
    )
    assert (few.groups, many.groups) == (4, 8)
    text = report(Identified(data, few))
    assert "jackknife over 4 motions" in text
    assert "warning: 4 motions are too few for these errors" in text
    assert "warning" not in report(Identified(data, many))
    rmse = [[s.rmse for s in row] for row in predicted_scores(data, many, prepared)]
    np.testing.assert_allclose(many.median_deg, np.median(rmse, axis=0), rtol=1e-6)
    assert many.rms_deg == pytest.approx(np.sqrt(np.mean(np.square(rmse))), rel=1e-6)


def predicted_scores(data, found, prepared):
    paths = [p.path for p in found.parameters]
    new = changed(data, dict(zip(paths, map(float, found.values), strict=True)))
    drive = drive_model(vehicle_from_data(new))
    return [scores(each.trial, dynamic(each, *drive).tilt) for each in prepared]


def test_the_vehicle_file_is_not_written_over(tmp_path, capsys):
    mine = tmp_path / "mine.yaml"
    mine.write_text(VEHICLE.read_text(encoding="utf-8"), encoding="utf-8")
    other = tmp_path / "sub" / ".." / "mine.yaml"
    (tmp_path / "sub").mkdir()
    assert main(["identify", str(DATA), "--vehicle", str(mine), "--output", str(other)]) == 2
    assert f"--output {other} is the vehicle file itself" in capsys.readouterr().err


def test_an_arm_at_rest_shows_little(data):
    """In one pose of the arm, its heading and the static moment cannot be separated."""
    resting = [each for each in prepared_trials(str(DATA)) if "baseline" in each.trial.name]
    candidates = chosen(data, *STATIC[:2], "arm.base.rpy_deg.2", "hull.linear_damping.3")
    found = identify(data, resting, candidates=candidates)
    fitted = {parameter.path for parameter in found.fit.parameters}
    assert "arm.base.rpy_deg.2" not in fitted
    assert "hull.cb_m.0" in fitted
    assert "heading of the arm's base" in found.refused


def test_nothing_at_all_is_an_error(data):
    resting = [each for each in prepared_trials(str(DATA)) if "baseline" in each.trial.name]
    with pytest.raises(TrialError, match="determine none of the constants:\n  quadratic roll"):
        identify(data, resting, candidates=chosen(data, "hull.quadratic_damping.3"))


def test_two_trials_are_too_few_for_errors(data, made):
    with pytest.raises(TrialError, match=r"2 trials are too few to show how well .* at least 3"):
        fit(data, [prepare_trial(trial) for trial in made[1][:2]], chosen(data, *STATIC))


def test_repeats_of_a_motion_are_one_group():
    assert group_of("traj005-0") == group_of("traj005-12") == "traj005"
    assert group_of("baseline1") == "baseline1"


class TestVehicleFile:
    """What of a vehicle file can be fitted, and how it is written."""

    def test_numbers_only(self):
        data = load_vehicle().model_dump(mode="json")
        data["hull"]["volume_m3"] = "spheroid"
        parameters, skipped = present(data)
        assert skipped["volume (net buoyancy)"].startswith("hull.volume_m3 is the word `spheroid`")
        assert skipped["pitch moment by depth"].startswith("the vehicle file has no tether")
        assert "hull.added_mass.3.3" in {p.path for p in parameters}

    def test_only_the_numbers_change(self):
        text = VEHICLE.read_text(encoding="utf-8")
        new = rewritten(
            text, {"hull.cb_m.2": (-0.0312345678, 3e-4), "arm.base.rpy_deg.2": (5.0, 0.5)}
        )
        before, after = text.splitlines(), new.splitlines()
        different = [
            k for k, pair in enumerate(zip(before, after, strict=True)) if len(set(pair)) > 1
        ]
        assert len(different) == 2
        assert "-0.03123] # [id]" in after[different[0]]
        data = yaml.safe_load(new)
        assert data["hull"]["cb_m"][2] == -0.03123
        assert data["arm"]["base"]["rpy_deg"] == [180.0, 0.0, 5.0]

    def test_every_candidate_is_in_the_shipped_file(self, data):
        parameters, skipped = present(data)
        assert len(parameters) == len(CANDIDATES)
        assert not skipped

    def test_the_command_writes_it(self, tmp_path, capsys, made, data, monkeypatch):
        """The file is a vehicle file, and its comments are there."""
        few = tuple(chosen(data, *STATIC, "hull.quadratic_damping.3"))
        monkeypatch.setattr(identify_module, "CANDIDATES", few)
        trials = tmp_path / "trials"
        trials.mkdir()
        for trial in made[1][:4]:
            write_trial(trial, trials)
        output = tmp_path / "out" / "mine.yaml"
        arguments = ["identify", str(trials), "--vehicle", str(VEHICLE), "--output", str(output)]
        assert main(arguments) == 0
        printed = capsys.readouterr()
        assert f"written: {output}" in printed.out
        assert "std error" in printed.out
        assert "giving up" in printed.err
        assert load_vehicle(output).name == "bluerov2_alpha5"
        assert "# A real vehicle" in output.read_text(encoding="utf-8")
