"""`uvms navigate` on logs of other systems, with each kind of sensor, axes and frame."""

import json

import foreign_logs as foreign
import numpy as np
import pytest

from uvms_analysis.log.read import RunLog
from uvms_bringup.cli import main
from uvms_core import topics
from uvms_core.vehicle import dump_vehicle, load_vehicle

REP_103 = {"sensors.imu.axes": "flu", "sensors.imu.world": "enu", "sensors.dvl.axes": "flu"}
PLACE = {"rate_hz": 5.0, "position_m": [0.1, 0.0, 0.2]}
USBL = {"rate_hz": 2.0, "position_m": [-0.2, 0.1, -0.1], "noise_m": 1.0}
LESS = {"sensors.pressure": None, "sensors.gps": None}
NO_ATTITUDE = {
    "sensors.imu.orientation": False,
    "sensors.imu.axes": "flu",
    "sensors.imu.gyro_bias_deg_s": 0.001,
}


@pytest.fixture(scope="module")
def run():
    return foreign.voyage()


def vehicle_of(tmp_path, overrides):
    """A vehicle and its file."""
    vehicle = load_vehicle(overrides=overrides)
    path = tmp_path / "auv.yaml"
    path.write_text(dump_vehicle(vehicle), encoding="utf-8")
    return vehicle, str(path)


def navigated(log, vehicle_file, tmp_path, *topics_given):
    """Summary of the command and the estimates in its log."""
    words = ["navigate", str(log), "--vehicle", vehicle_file, "--output", str(tmp_path / "out")]
    assert main([*words, *(["--topics", *topics_given] if topics_given else [])]) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    return summary, RunLog.open(tmp_path / "out" / "odometry.mcap").signals(topics.ODOMETRY)


def assert_right(run, estimates, share=0.97):
    """Position, velocity and attitude of the estimates against the truth, in 3 sigma per axis."""
    stamps = np.array([each.stamp + foreign.EPOCH for each in run.truth], dtype=np.int64)
    place = np.array([each.position for each in run.truth])
    speed = np.array([each.nu[:3] for each in run.truth])
    inside = []
    for each in estimates:
        if each.stamp > stamps[-1]:
            continue
        since = (stamps - stamps[0]).astype(float)
        now = float(each.stamp - stamps[0])
        true = [np.interp(now, since, column) for column in (*place.T, *speed.T)]
        error = np.concatenate([each.position, each.nu[:3]]) - true
        variance = np.concatenate(
            [np.diagonal(each.pose_covariance)[:3], np.diagonal(each.twist_covariance)[:3]]
        )
        inside.append(np.abs(error) <= 3.0 * np.sqrt(variance))
    assert len(inside) > 300
    assert np.mean(inside, axis=0).min() >= share, np.mean(inside, axis=0)
    return estimates[-1]


@pytest.mark.parametrize("storage", foreign.STORES)
def test_rep_103_with_satellites_twist_and_pressure(run, tmp_path, storage, capsys):
    """No clock, no transforms; the topics' names say nothing, and all but one need no map."""
    vehicle, file = vehicle_of(tmp_path, {**REP_103, "sensors.gps.horizontal_noise_m": 0.3})
    messages = [
        *foreign.imu(run, "/mti", axes="flu"),
        *foreign.dvl(run, "/a50/vel", axes="flu"),
        *foreign.dvl(run, "/wheel/twist"),
        *foreign.pressure(run, "/bar30"),
        *foreign.satellites(run, "/ublox/fix", vehicle, 0.3),
        *foreign.reference(run, "/mocap/odom"),
    ]
    log = foreign.written(tmp_path / "log", storage, messages)
    summary, estimates = navigated(log, file, tmp_path, "dvl=/a50/vel")
    assert summary["topics"] == {
        "imu": "/mti", "dvl": "/a50/vel", "pressure": "/bar30", "gps": "/ublox/fix"
    }  # fmt: skip
    assert summary["unreadable"] == {}
    assert summary["counts"]["gps_accepted"] >= 3
    last = assert_right(run, estimates)
    assert np.sqrt(last.pose_covariance[0, 0]) < 0.3
    assert summary["position_inside_3_sigma"] == summary["attitude_inside_3_sigma"] == 1.0
    assert "in 'odom', taken for east-north-up" in capsys.readouterr().out


@pytest.mark.parametrize("frame", ["map", "map_ned"])
def test_fixes_depth_and_a_heading_with_a_bare_inertial_unit(run, tmp_path, frame):
    """What the log has not, the vehicle's DVL, is said, and is no trouble."""
    added = {
        "sensors.position_fix": USBL,
        "sensors.depth": {**PLACE, "noise_m": 0.02},
        "sensors.heading": {**PLACE, "axes": "flu", "world": "enu", "noise_deg": 1.0},
    }
    vehicle, file = vehicle_of(tmp_path, {**LESS, **NO_ATTITUDE, **added})
    messages = [
        *foreign.imu(run, "/imu", axes="flu", attitude=False),
        *foreign.fixes(run, "/usbl", vehicle, frame),
        *foreign.depths(run, "/depth", vehicle),
        *foreign.headings(run, "/compass", 1.0),
        *foreign.reference(run, "/truth"),
    ]
    log = foreign.written(tmp_path / "log", "mcap", messages)
    (file_of_log,) = log.glob("*.mcap")
    given = ["imu=/imu", "position_fix=/usbl", "depth=/depth", "heading=/compass"]
    summary, estimates = navigated(file_of_log, file, tmp_path, *given)
    assert summary["unreadable"] == {}
    last = assert_right(run, estimates)
    assert np.sqrt(last.pose_covariance[:3, :3].diagonal()).max() < 0.15
    assert summary["attitude_inside_3_sigma"] >= 0.97
    lacks = "dvl: left out, since the log has no geometry_msgs/msg/TwistWithCovarianceStamped"
    assert lacks in summary["notes"]
    assert "dvl" not in summary["trouble"]


@pytest.mark.parametrize("storage", foreign.STORES)
def test_a_marine_dvl_and_a_magnetometer(run, tmp_path, storage):
    """The definition of a message that is not installed here is in the log."""
    added = {
        "sensors.dvl.message": foreign.MARINE,
        "sensors.magnetometer": {**PLACE, "axes": "flu", "noise_ut": 0.3},
        "environment.magnetic_field_ut": [17.0, 4.0, 45.0],
    }
    vehicle, file = vehicle_of(tmp_path, {"sensors.gps": None, **NO_ATTITUDE, **added})
    messages = [
        *foreign.imu(run, "/imu", axes="flu", attitude=False),
        *foreign.marine_dvl(run, "/dvl"),
        *foreign.pressure(run, "/bar30"),
        *foreign.fields(run, "/mag", vehicle),
        *foreign.reference(run, "/truth"),
    ]
    log = foreign.written(tmp_path / "log", storage, messages)
    summary, estimates = navigated(log, file, tmp_path)
    assert summary["unreadable"] == {}
    assert summary["counts"]["dvl_accepted"] > 100
    assert_right(run, estimates)
    assert summary["position_error_m"]["max"] < 0.2
    assert summary["attitude_inside_3_sigma"] >= 0.97


class TestRefused:
    """What cannot be navigated, in one line that names what is wrong and what to do."""

    def said(self, capsys, log, *options):
        assert main(["navigate", str(log), *options]) == 2
        return capsys.readouterr().err

    def test_a_log_without_an_inertial_unit(self, run, tmp_path, capsys):
        log = foreign.written(tmp_path / "log", "mcap", foreign.pressure(run, "/bar30"))
        text = self.said(capsys, log, "--vehicle", "reference_auv")
        assert "has no sensor_msgs/msg/Imu, which navigation needs" in text
        assert "/bar30 [sensor_msgs/msg/FluidPressure]" in text

    def test_a_vehicle_without_an_inertial_unit(self, run, tmp_path, capsys):
        log = foreign.written(tmp_path / "log", "mcap", foreign.imu(run, "/imu"))
        vehicle = load_vehicle().model_dump(mode="json", warnings=False)
        del vehicle["sensors"]["imu"]
        (tmp_path / "auv.yaml").write_text(json.dumps(vehicle), encoding="utf-8")
        text = self.said(capsys, log, "--vehicle", str(tmp_path / "auv.yaml"))
        assert "sensors.imu" in text

    def test_an_inertial_unit_without_attitude_and_no_heading_in_the_log(
        self, run, tmp_path, capsys
    ):
        added = {"sensors.heading": {**PLACE, "noise_deg": 1.0}}
        _, file = vehicle_of(tmp_path, {**NO_ATTITUDE, **added})
        messages = foreign.imu(run, "/imu", axes="flu", attitude=False)
        log = foreign.written(tmp_path / "log", "mcap", messages)
        text = self.said(capsys, log, "--vehicle", file)
        assert "no sensor measures the heading" in text
        assert "heading: left out, since the log has no sensor_msgs/msg/Imu besides" in text

    @pytest.mark.parametrize("storage", foreign.STORES)
    def test_a_clock_that_was_set_back(self, run, tmp_path, capsys, storage):
        messages = foreign.set_back(foreign.imu(run, "/imu"), 8.0, 5.0)
        log = foreign.written(tmp_path / "log", storage, messages)
        text = self.said(capsys, log, "--vehicle", "reference_auv")
        assert "the stamps of /imu go back from" in text
        assert "--stamps log" in text
        words = ["--vehicle", "reference_auv", "--stamps", "log", "--output", str(tmp_path / "out")]
        assert main(["navigate", str(log), *words]) == 0

    def test_axes_that_are_not_declared(self, run, tmp_path, capsys):
        """Specific force down where it must be up: nothing can begin, and the fields are named."""
        log = foreign.written(tmp_path / "log", "mcap", foreign.imu(run, "/imu", axes="flu"))
        text = self.said(capsys, log, "--vehicle", "reference_auv")
        assert "sensors.imu.axes: flu" in text

    def test_one_topic_that_may_be_of_two_sensors(self, run, tmp_path, capsys):
        """Neither is guessed; the choice is named."""
        added = {"sensors.position_fix": USBL, "sensors.depth": {**PLACE, "noise_m": 0.02}}
        vehicle, file = vehicle_of(tmp_path, added)
        messages = [*foreign.imu(run, "/imu"), *foreign.depths(run, "/pose", vehicle)]
        log = foreign.written(tmp_path / "log", "mcap", messages)
        summary, _ = navigated(log, file, tmp_path)
        assert summary["topics"] == {"imu": "/imu"}
        printed = capsys.readouterr().out
        assert "depth: left out, since /pose may as well be that of position_fix" in printed
        assert "--topics depth=/pose" in printed
