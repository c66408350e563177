"""Folders of trials: what is read, and what is refused with which words."""

import numpy as np
import pytest
from made_trials import DATA, HEADER, made_trial, write_trial

from uvms_analysis.errors import TrialError
from uvms_analysis.trials.read import read_trial, read_trials
from uvms_core.vehicle import load_vehicle


@pytest.fixture
def lines():
    """Text of a small trial, line by line."""
    rows = [",".join([f"{0.04 * k:.2f}", *["0.5"] * 13]) for k in range(40)]
    return [HEADER, *rows]


def refusal(tmp_path, lines):
    file = tmp_path / "mine.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    with pytest.raises(TrialError) as fault:
        read_trial(file)
    return str(fault.value).removeprefix(f"{file}: ")


def test_the_shipped_trials():
    trials = read_trials(DATA)
    assert len(trials) == 20
    assert trials[0].name == "baseline1"
    assert sum(len(trial.t) for trial in trials) == 11485
    assert not all(trial.accepted.all() for trial in trials)


def test_a_missing_value_is_named_by_line_and_column(tmp_path, lines):
    values = lines[7].split(",")
    values[4] = ""
    lines[7] = ",".join(values)
    assert refusal(tmp_path, lines).startswith("line 8: column roll: the value is missing")
    values[4] = "nan"
    lines[7] = ",".join(values)
    assert refusal(tmp_path, lines).startswith("line 8: column roll: 'nan' is not finite")
    values[4] = "level"
    lines[7] = ",".join(values)
    assert refusal(tmp_path, lines) == "line 8: column roll: 'level' is not a number"
    lines[7] = ",".join(values[:3])
    assert refusal(tmp_path, lines).startswith("line 8: column z: the value is missing")


def test_a_missing_column(tmp_path, lines):
    lines[0] = HEADER.replace("q_e", "q_f").replace("pitch", "nose")
    assert refusal(tmp_path, lines).startswith(
        "line 1: lacks the column pitch, q_e; a trial has t,"
    )


def test_time_must_go_on(tmp_path, lines):
    lines[9] = lines[8]
    assert refusal(tmp_path, lines) == "line 10: column t: 0.28 must be later than 0.28"


def test_too_short(tmp_path, lines):
    assert refusal(tmp_path, lines[:11]) == "has 10 samples; a trial has at least 25"
    assert refusal(tmp_path, []).startswith("line 1: lacks the column t, x")


def test_nothing_to_score(tmp_path, lines):
    lines = [f"{line},{'moc_ok' if k == 0 else '0'}" for k, line in enumerate(lines)]
    assert refusal(tmp_path, lines).startswith("column moc_ok: is 0 throughout")


def test_folders(tmp_path):
    with pytest.raises(TrialError, match="nowhere: no such folder"):
        read_trials(tmp_path / "nowhere")
    with pytest.raises(TrialError, match=r"holds no \*\.csv"):
        read_trials(tmp_path)


def test_a_folder_of_ones_own(tmp_path):
    """Other names, no moc_ok, no trials.json: what was written is read."""
    made = made_trial(load_vehicle("bluerov2_alpha5"), 7)
    write_trial(made, tmp_path)
    (trial,) = read_trials(tmp_path)
    assert trial.name == "made7"
    assert trial.accepted.all()
    np.testing.assert_allclose(trial.attitude, made.attitude, atol=1e-6)
    np.testing.assert_allclose(trial.alpha, made.alpha, atol=1e-6)


class TestUnits:
    """What the numbers betray; the shipped trials are the ones that must pass."""

    @pytest.fixture
    def columns(self):
        file = DATA / "traj026-1.csv"
        header = file.read_text(encoding="utf-8").splitlines()[0].split(",")
        return dict(zip(header, np.loadtxt(file, delimiter=",", skiprows=1).T, strict=True))

    @pytest.fixture
    def notes(self, tmp_path, columns):
        """Notes on the changed columns, without the file's name."""

        def read(**changed):
            new = {**columns, **changed}
            new = {name: values for name, values in new.items() if values is not None}
            file, notes_logged = tmp_path / "mine.csv", []
            rows = np.column_stack(list(new.values()))
            np.savetxt(file, rows, delimiter=",", header=",".join(new), comments="")
            read_trial(file, notes_logged.append)
            return [note.removeprefix(f"note: {file}: ") for note in notes_logged]

        return read

    def test_shipped_trials_are_beyond_doubt(self):
        notes_logged = []
        read_trials(DATA, notes_logged.append)
        assert notes_logged == []

    def test_joint_angles_in_degrees(self, notes, columns):
        with pytest.raises(TrialError, match=r"column q_e: .* are these radians\?"):
            notes(q_e=np.degrees(columns["q_e"]))
        assert notes(q_b=columns["q_b"] + 4.0) == []

    def test_tilt_in_radians(self, notes, columns):
        tilt = {name: np.radians(columns[name]) for name in ("roll", "pitch")}
        with pytest.raises(TrialError, match="columns roll, pitch: are radians"):
            notes(**tilt)
        (note,) = notes(**tilt, qw=None)
        assert "are they degrees?" in note
        blank = np.full(len(columns["t"]), np.nan)
        (note,) = notes(**tilt, qw=blank)
        assert "are they degrees?" in note

    def test_tilt_that_is_not_the_quaternions(self, notes, columns):
        (note,) = notes(pitch=columns["pitch"] + 3.0)
        assert note.startswith("roll and pitch differ from the quaternion beside them by 3 deg")
        some = np.where(np.arange(len(columns["t"])) < 50, np.nan, columns["qx"])
        assert notes(qx=some) == []

    def test_holes_in_time(self, notes, columns):
        t = columns["t"]
        later = np.where(t > t[100], 0.46, 0.0) + np.where(t > t[150], 0.26, 0.0)
        (note,) = notes(t=t + later)
        assert note.startswith(f"no samples for 0.50 s after t = {t[100]:g} s; 1 more of over 0.2")

    def test_a_sensor_with_gaps_is_none(self, tmp_path, lines):
        lines = [
            f"{line},{'imu_roll,imu_pitch' if k == 0 else '0.1,'}" for k, line in enumerate(lines)
        ]
        file = tmp_path / "mine.csv"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        assert read_trial(file).sensor is None
