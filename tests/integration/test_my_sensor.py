"""A sensor that only an external package knows: in the vehicle file, the log and the filter."""

import numpy as np
import pytest
import yaml
from added_sensor import SECTION, installed, uvms, vehicle_file

from uvms_analysis.log.read import RunLog
from uvms_core import topics

SECONDS = 60
DVL_NOISE = 0.1  # m/s: dead reckoning drifts by 0.1 sqrt(60 / 8) = 0.27 m in 60 s


@pytest.fixture(scope="module")
def environment(tmp_path_factory):
    return installed(tmp_path_factory.mktemp("installed"))


@pytest.fixture(scope="module")
def runs(tmp_path_factory, environment):
    """Logs of hovering without and with the acoustic position."""
    logs = []
    for sections in ({}, {"usbl": SECTION}):
        folder = tmp_path_factory.mktemp("run")
        vehicle = vehicle_file(folder, DVL_NOISE, **sections)
        arguments = ("--duration", SECONDS, "--set", f"vehicle={vehicle}", "--output", folder)
        done = uvms(environment, "simulate", "hover", *arguments)
        # With so poor a DVL the vehicle drifts farther than a run may; the fixes keep it in place.
        assert done.returncode == (0 if sections else 1), done.stdout + done.stderr
        logs.append(RunLog.open(folder / "run.mcap"))
    return logs


def horizontal_error(log):
    """Of the estimated position over the second half of the run, rms in m."""
    log.load([topics.ODOMETRY, topics.TRUE_ODOMETRY])
    off = log.series(topics.ODOMETRY).position - log.series(topics.TRUE_ODOMETRY).position
    return np.sqrt(np.mean(np.sum(off[len(off) // 2 :, :2] ** 2, axis=1)))


def test_the_log_has_its_samples_at_its_own_rate(runs):
    without, with_usbl = runs
    assert "/sensors/usbl" not in without.topics
    assert with_usbl.topics["/sensors/usbl"] == "geometry_msgs/msg/PointStamped"
    stamps = [stamp for _, stamp, _ in with_usbl.raw(["/sensors/usbl"])]
    assert stamps == list(range(0, SECONDS * 10**9 + 1, 10**9))


def test_samples_have_the_noise_and_the_place_of_the_vehicle_file(runs):
    log = runs[1]
    decode = log.codec("/sensors/usbl").decode
    points = [decode(data).point for _, _, data in log.raw(["/sensors/usbl"])]
    measured = np.array([[point.x, point.y, point.z] for point in points])
    truth = log.series(topics.TRUE_ODOMETRY).position[:: round(1.0 / 0.05)]
    off = measured - truth - SECTION["position_m"]  # the vehicle hovers nearly level, facing north
    np.testing.assert_allclose(off.mean(axis=0), 0.0, atol=0.05)
    np.testing.assert_allclose(off.std(axis=0), SECTION["noise_m"], rtol=0.35)


def test_the_filter_uses_it_against_the_drift(runs):
    drifting, fixed = map(horizontal_error, runs)
    assert drifting > 0.1
    assert fixed < 0.5 * drifting
    stated = [log.series(topics.ODOMETRY).pose_covariance[-1, 0, 0] ** 0.5 for log in runs]
    assert stated[1] < 0.5 * stated[0]


def test_the_random_numbers_of_the_other_sensors_stay(runs):
    first = [log.series(topics.GPS).stamps for log in runs]
    np.testing.assert_array_equal(*first)
    pressures = [log.series(topics.PRESSURE).pressure[0] for log in runs]
    assert pressures[0] == pressures[1]


def test_a_vehicle_file_with_an_unknown_sensor_is_refused(tmp_path):
    vehicle = vehicle_file(tmp_path, DVL_NOISE, usbl=SECTION)
    done = uvms({}, "simulate", "hover", "--set", f"vehicle={vehicle}", "--output", tmp_path)
    assert done.returncode != 0
    assert (
        "sensors.usbl: no installed package brings a sensor 'usbl' (entry point in uvms.sensors);"
        " choose from depth, dvl, gps, heading, imu, magnetometer, position_fix,"
        " pressure, target_marker"
    ) in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"noise_m": 0.0}, "sensors.usbl.noise_m: Input should be greater than 0 (got 0.0)"),
        (
            {"nois_m": 1.0},
            "sensors.usbl.nois_m: Extra inputs are not permitted; known names here: axes,"
            " drop_out_rate, frame_id, latency_s, noise_m, position_m, rate_hz, rpy_deg, topic,",
        ),
        ({"rate_hz": 7.0}, "the period of vehicle.sensors.usbl.rate_hz = 7: 0.142857 s is not a"),
    ],
)
def test_its_section_is_checked_like_any_other(change, message, environment, tmp_path):
    vehicle = vehicle_file(tmp_path, DVL_NOISE, usbl=SECTION | change)
    done = uvms(
        environment, "simulate", "hover", "--set", f"vehicle={vehicle}", "--output", tmp_path
    )
    assert done.returncode != 0
    assert message in done.stderr


def test_the_vehicle_of_a_log_can_be_loaded_again(runs, environment, tmp_path):
    text = runs[1].text("vehicle.yaml")
    assert SECTION.items() <= yaml.safe_load(text)["sensors"]["usbl"].items()
    path = tmp_path / "again.yaml"
    path.write_text(text, encoding="utf-8")
    settings = (f"vehicle={path}", "vehicle.sensors.usbl.rate_hz=2")
    options = [item for setting in settings for item in ("--set", setting)]
    done = uvms(
        environment, "simulate", "hover", "--duration", 1, *options, "--output", tmp_path / "run"
    )
    assert done.returncode == 0, done.stderr
    log = RunLog.open(tmp_path / "run" / "run.mcap")
    assert len(list(log.raw(["/sensors/usbl"]))) == 3
