"""`uvms navigate` on a run of our own, and on the same as another system would have recorded it."""

import dataclasses
import json

import numpy as np
import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from uvms_analysis.log.read import RunLog
from uvms_bringup.cli import main
from uvms_bringup.navigate.against_reference import Track, at, errors, read_track
from uvms_bringup.navigate.bag import open_bag
from uvms_bringup.navigate.clocks import ClockError
from uvms_bringup.navigate.navigate import navigate
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.messages import to_message
from uvms_core.signals import Odometry
from uvms_core.world_frames import R_MAP_MAP_NED
from uvms_dynamics import quat_to_matrix

EPOCH = 1_795_000_000_123_456_789
"""A time in 2026, ns, that is no multiple of anything."""
NAMES = {
    topics.IMU: ("/xsens/data", "xsens"),
    topics.DVL: ("/dvl/twist", "dvl_a50"),
    topics.PRESSURE: ("/bar30/pressure", "bar30"),
}
STORES = {"mcap": StoragePlugin.MCAP, "sqlite": StoragePlugin.SQLITE3}
POSE = "geometry_msgs/msg/PoseStamped"
VEHICLE = "reference_auv"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Six seconds under way, whose DVL comes late for two of them."""
    folder = tmp_path_factory.mktemp("navigate") / "run"
    late = "events=[{at_s: 2.0, sensor: dvl, fault: latency, latency_s: 0.15, until_s: 4.0}]"
    words = ["simulate", "hover", "--duration", "6", "--seed", "3", "--set", late]
    assert main([*words, "--output", str(folder)]) == 0
    return folder / "run.mcap"


def written(folder, storage, messages):
    """A bag of (topic, type, ns, plain message); returns its folder."""
    store = get_typestore(Stores.ROS2_JAZZY)
    with Writer(folder, version=9, storage_plugin=STORES[storage]) as bag:
        known = {}
        for topic, type_name, stamp, message in messages:
            if topic not in known:
                known[topic] = bag.add_connection(topic, type_name, typestore=store)
            bag.write(known[topic], stamp, codec(type_name).encode(message))
    return folder


def as_another_system(run, names=NAMES):
    """Messages of a run with stamps of a wall clock, foreign names, a reference in REP-103."""
    log = RunLog.open(run)
    found = []
    for topic, (name, frame) in names.items():
        for signal in log.signals(topic):
            message = to_message(topic, signal)
            found.append((signal.stamp + EPOCH, name, topic.type, stamped(message, signal, frame)))
    for true in log.signals(topics.TRUE_ODOMETRY)[::2]:
        message = stamped({"pose": enu_pose(true)}, true, "odom")
        found.append((true.stamp + EPOCH, "/mocap/pose", POSE, message))
    found.sort(key=lambda each: each[0])
    return [(name, kind, stamp + 3_000_000, message) for stamp, name, kind, message in found]


def stamped(message, signal, frame):
    sec, nanosec = divmod(signal.stamp + EPOCH, 10**9)
    return message | {"header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame}}


def enu_pose(true):
    """The true pose in east-north-up and forward-left-up, by matrices."""
    R = R_MAP_MAP_NED @ quat_to_matrix(true.quaternion) @ np.diag([1.0, -1.0, -1.0])
    w = 0.5 * np.sqrt(max(1.0 + np.trace(R), 1e-12))
    x, y, z = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (4.0 * w)
    p = R_MAP_MAP_NED @ true.position
    return {
        "position": dict(zip("xyz", map(float, p), strict=True)),
        "orientation": {"x": float(x), "y": float(y), "z": float(z), "w": float(w)},
    }


def test_a_run_of_our_own_comes_out_again(run, tmp_path, capsys):
    """Bit for bit, without a map, samples that came late included."""
    assert RunLog.open(run).has(topics.SENSOR_GAPS)
    assert main(["navigate", str(run), "--output", str(tmp_path)]) == 0
    printed = capsys.readouterr().out
    assert "against /ground_truth/odometry" in printed
    assert "note:" not in printed
    recorded = RunLog.open(run).signals(topics.ODOMETRY)
    again = RunLog.open(tmp_path / "odometry.mcap").signals(topics.ODOMETRY)
    assert len(again) == len(recorded) == 121
    for one, other in zip(again, recorded, strict=True):
        assert one.stamp == other.stamp
        np.testing.assert_array_equal(one.position, other.position)
        np.testing.assert_array_equal(one.nu, other.nu)
        np.testing.assert_array_equal(one.pose_covariance, other.pose_covariance)
    summary = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))
    assert summary["position_inside_3_sigma"] == 1.0
    assert summary["health"]["dvl"] == "good"
    assert summary["counts"]["samples_late"] > 0


@pytest.mark.parametrize("storage", STORES)
def test_a_log_of_another_system(run, tmp_path, storage):
    """Its topics are found by their types, which is said; the estimate is right in 3 sigma."""
    bag = written(tmp_path / "bag", storage, as_another_system(run))
    summary = navigate(bag, VEHICLE, {}, tmp_path / "out")
    assert summary["topics"] == {
        "imu": "/xsens/data",
        "dvl": "/dvl/twist",
        "pressure": "/bar30/pressure",
    }
    notes = "\n".join(summary["notes"])
    assert "imu: /xsens/data, the only sensor_msgs/msg/Imu" in notes
    assert "reference: /mocap/pose in 'odom', taken for east-north-up" in notes
    assert summary["estimates"] == 121
    assert summary["unreadable"] == {}
    assert summary["position_inside_3_sigma"] == 1.0
    assert summary["attitude_inside_3_sigma"] == 1.0
    assert summary["position_error_m"]["max"] < 0.02
    assert summary["attitude_error_deg"]["max"] < 0.1


def test_the_only_file_of_a_bag_is_as_good_as_its_folder(run, tmp_path):
    bag = written(tmp_path / "bag", "sqlite", as_another_system(run))
    (file,) = bag.glob("*.db3")
    named = {"imu": "xsens/data", "reference": "none", "dvl": "none"}
    summary = navigate(file, VEHICLE, named, tmp_path / "out")
    assert "dvl" not in summary["topics"]
    assert summary["reference"] is None
    assert "position_error_m" not in summary


def test_one_stamp_astray_is_one_message_lost(run, tmp_path):
    """A message from the year 1970 among those of today, and one without sense."""
    messages = as_another_system(run)
    index = next(k for k, each in enumerate(messages) if each[0] == "/dvl/twist") + 40
    while messages[index][0] != "/dvl/twist":
        index += 1
    name, kind, logged, message = messages[index]
    header = {"stamp": {"sec": 5, "nanosec": 0}, "frame_id": "dvl_a50"}
    messages[index] = (name, kind, logged, message | {"header": header})
    bag = written(tmp_path / "bag", "mcap", messages)
    summary = navigate(bag, VEHICLE, {}, tmp_path / "out")
    assert summary["unreadable"] == {"/dvl/twist": 1}
    assert "its stamp 5.000 s is astray" in summary["first_unreadable"]["/dvl/twist"]
    assert summary["estimates"] == 121


def test_two_clocks_in_one_log(run, tmp_path):
    """A DVL that counts from its start: said with the remedy, and the remedy works."""
    messages = []
    for name, kind, logged, message in as_another_system(run):
        if name == "/dvl/twist":
            sec, nanosec = divmod(logged - EPOCH, 10**9)
            message = message | {
                "header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": ""}
            }
        messages.append((name, kind, logged, message))
    bag = written(tmp_path / "bag", "mcap", messages)
    with pytest.raises(ClockError, match=r"the stamps of /dvl/twist are .* s off .*--stamps log"):
        navigate(bag, VEHICLE, {}, tmp_path / "out")
    summary = navigate(bag, VEHICLE, {}, tmp_path / "out", "log")
    assert summary["position_inside_3_sigma"] == 1.0


@pytest.fixture(scope="module")
def bag(run, tmp_path_factory):
    """The beginning of such a log, with a second inertial unit."""
    messages = as_another_system(run)[:300]
    second = [("/imu2/data", *each[1:]) for each in messages if each[0] == "/xsens/data"]
    mixed = sorted(messages + second, key=lambda each: each[2])
    return written(tmp_path_factory.mktemp("errors") / "bag", "mcap", mixed)


class TestErrors:
    """One line that names what there is to choose from."""

    @pytest.mark.parametrize(
        ("options", "text"),
        [
            ((), "does not say which vehicle it is of: name its file by --vehicle"),
            (("--vehicle", VEHICLE), "which of /imu2/data, /xsens/data is the inertial unit?"),
            (
                ("--vehicle", VEHICLE, "--topics", "imu=/imu"),
                "--topics imu=/imu: is not in the log; imu must be sensor_msgs/msg/Imu, and of"
                " these",
            ),
            (
                ("--vehicle", VEHICLE, "--topics", "imu=/dvl/twist"),
                "is geometry_msgs/msg/TwistWithCovarianceStamped; imu must be sensor_msgs/msg/Imu",
            ),
            (
                ("--vehicle", VEHICLE, "--topics", "sonar=/xsens/data"),
                "has no sensor 'sonar' that navigation uses; choose one of imu, dvl, pressure, gps",
            ),
            (("--vehicle", VEHICLE, "--topics", "nowhere.yaml"), "nowhere.yaml: cannot be read"),
        ],
    )
    def test_topics(self, bag, capsys, options, text):
        assert main(["navigate", str(bag), *options]) == 2
        printed = capsys.readouterr().err
        assert printed.startswith("error: ")
        assert text in printed

    def test_a_map_in_a_file(self, bag, tmp_path, capsys):
        file = tmp_path / "map.yaml"
        file.write_text("imu: /xsens/data\nreference: /mocap/pose\n", encoding="utf-8")
        words = ["navigate", str(bag), "--vehicle", VEHICLE, "--topics", str(file), "dvl=none"]
        assert main([*words, "--output", str(tmp_path / "out"), "--json"]) == 0
        summary = json.loads(capsys.readouterr().out)
        assert summary["topics"] == {"imu": "/xsens/data", "pressure": "/bar30/pressure"}

    def test_no_log(self, tmp_path, capsys):
        assert main(["navigate", str(tmp_path / "none.mcap"), "--vehicle", VEHICLE]) == 2
        assert "no such file or folder" in capsys.readouterr().err
        (tmp_path / "text.mcap").write_text("nothing", encoding="utf-8")
        assert main(["navigate", str(tmp_path / "text.mcap"), "--vehicle", VEHICLE]) == 2
        assert "is not an MCAP file" in capsys.readouterr().err
        (tmp_path / "text.db3").write_text("nothing", encoding="utf-8")
        assert main(["navigate", str(tmp_path / "text.db3"), "--vehicle", VEHICLE]) == 2
        assert "cannot be read" in capsys.readouterr().err


def turning(count):
    """A track that goes north at 2 m/s and turns about down at 0.1 rad/s, ten poses a second."""
    t = 0.1 * np.arange(count)
    quaternion = np.stack([0 * t, 0 * t, np.sin(0.05 * t), np.cos(0.05 * t)], axis=1)
    position = np.stack([2.0 * t, 0 * t, 5.0 + 0 * t], axis=1)
    return Track(np.rint(1e9 * t).astype(np.int64), position, quaternion, "map_ned", False)


def test_between_two_poses_of_the_reference():
    stamps = np.array([-1, 0, 250_000_000, 333_000_000, 900_000_000, 900_000_001])
    inside, position, quaternion = at(turning(10), stamps)
    np.testing.assert_array_equal(inside, [False, True, True, True, True, False])
    np.testing.assert_allclose(position[:, 0], 2e-9 * stamps[1:5], atol=1e-12)
    np.testing.assert_allclose(quaternion[:, 2], np.sin(5e-11 * stamps[1:5]), atol=1e-9)


def test_errors_in_closed_form():
    """An estimate 3 m east and turned by 0.2 rad about down, with known deviations."""
    track = turning(20)
    pose = np.diag([1.0, 1.01, 1.0, 1.0, 1.0, 0.1**2])
    estimates = [
        Odometry(
            int(stamp),
            position + [0.0, 3.0, 0.0],
            np.array([0.0, 0.0, np.sin(0.05 * s + 0.1), np.cos(0.05 * s + 0.1)]),
            np.zeros(6), pose, np.eye(6),
        )
        for stamp, position in zip(track.stamps, track.position, strict=True)
        for s in [1e-9 * stamp]
    ]  # fmt: skip
    found = errors(estimates, track)
    assert found["compared"] == 20
    assert found["distance_travelled_m"] == pytest.approx(3.8)
    assert found["position_error_m"]["rms"] == pytest.approx(3.0)
    assert found["position_inside_3_sigma"] == 1.0
    assert found["attitude_error_deg"]["median"] == pytest.approx(np.degrees(0.2))
    assert found["attitude_inside_3_sigma"] == 1.0
    estimates = [
        Odometry(e.stamp, e.position, e.quaternion, e.nu, 0.04 * pose, e.twist_covariance)
        for e in estimates
    ]
    found = errors(estimates, track)
    assert found["position_inside_3_sigma"] == found["attitude_inside_3_sigma"] == 0.0
    later = dataclasses.replace(track, stamps=track.stamps + 10**12)
    assert errors(estimates, later) is None


def test_axes_of_the_reference(run, tmp_path):
    """A reference in REP-103 is the truth in our axes, to rounding."""
    bag = open_bag(written(tmp_path / "bag", "mcap", as_another_system(run)))
    track = read_track(bag, "/mocap/pose")
    true = RunLog.open(run).signals(topics.TRUE_ODOMETRY)[::2]
    np.testing.assert_allclose(track.position, [each.position for each in true], atol=1e-9)
    for quaternion, each in zip(track.quaternion, true, strict=True):
        R, expected = quat_to_matrix(quaternion), quat_to_matrix(each.quaternion)
        np.testing.assert_allclose(R, expected, atol=1e-7)
