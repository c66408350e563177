"""Logs: independent readers open them, a killed writer loses little, damage is reported."""

import os
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2.reader import Reader
from synthetic import Known, write_log

from uvms_analysis.errors import LogError
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.goal_file import path_from_json, path_to_json
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.recover import recover
from uvms_analysis.log.schema import qos_from_yaml, qos_yaml
from uvms_analysis.log.writer import CHUNK_SIZE, LogWriter
from uvms_core import topics
from uvms_core.cdr import codec, type_hash
from uvms_core.signals import PathGoal, Wrench
from uvms_core.topics import LATCHED, Qos

KNOWN = Known(duration=3.0, path_duration=2.0)
JOINTS = ("swing", "shoulder", "elbow", "wrist")


@pytest.fixture(scope="module")
def log_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("log") / "run.mcap"
    write_log(path, KNOWN)
    return path


def wrench_log(path, count, chunk_size=CHUNK_SIZE):
    with LogWriter(path, chunk_size) as log:
        signals = SignalWriter(log, (), ())
        for k in range(count):
            signals.write(topics.WRENCH_COMMAND, Wrench(k * 50_000_000, np.full(6, float(k))))


def test_mcap_ros2_decodes_every_message(log_file):
    with log_file.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        count = sum(1 for _ in reader.iter_decoded_messages())
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
    assert count == summary.statistics.message_count > 500


def test_rosbags_decodes_every_message(log_file):
    with AnyReader([log_file]) as reader:
        found = {}
        for connection, _, data in reader.messages():
            found.setdefault(connection.topic, []).append(
                reader.deserialize(data, connection.msgtype)
            )
    assert len(found["/odometry"]) == 61
    assert found["/thruster_command"][0].name[0] == "main"
    assert found["/reference"][0].points[0].joint_position.shape == (4,)


def test_rosbags_takes_it_for_a_recording_of_rosbag2(log_file):
    with Reader(log_file) as reader:
        connection = next(c for c in reader.connections if c.topic == "/odometry")
        assert connection.msgtype == "nav_msgs/msg/Odometry"
        assert connection.ext.serialization_format == "cdr"
        (qos,) = connection.ext.offered_qos_profiles
        assert (qos.reliability.name, qos.durability.name) == ("RELIABLE", "VOLATILE")


def test_channels_carry_what_rosbag2_writes(log_file):
    type_name, text, metadata = RunLog.open(log_file).channel("/odometry")
    assert type_name == "nav_msgs/msg/Odometry"
    assert b"MSG: geometry_msgs/Quaternion" in text
    assert metadata["topic_type_hash"] == type_hash(type_name)
    (profile,) = yaml.safe_load(metadata["offered_qos_profiles"])
    assert list(profile) == [
        "history",
        "depth",
        "reliability",
        "durability",
        "deadline",
        "lifespan",
        "liveliness",
        "liveliness_lease_duration",
        "avoid_ros_namespace_conventions",
    ]


@pytest.mark.parametrize("qos", [Qos(), Qos(7), LATCHED])
def test_quality_of_service_comes_back(qos):
    assert qos_from_yaml(qos_yaml(qos)) == qos


def test_attachments_and_metadata_come_back(log_file):
    log = RunLog.open(log_file)
    assert log.fault == ""
    assert log.run == {"scenario": "synthetic", "seed": "7", "git_revision": "abc"}
    assert log.configuration() == {"scenario": "synthetic", "seed": 7}
    with pytest.raises(LogError, match=r"has no attachment 'x'; it has config.yaml, vehicle.yaml"):
        log.text("x")


def test_every_topic_of_the_table_that_was_written_is_there(log_file):
    names = RunLog.open(log_file).topics
    sensors = {"/sensors/imu", "/sensors/dvl", "/sensors/pressure", "/sensors/gps"}
    viewers = {"/tf", "/tf_static", "/robot_description"}
    always = {t.resolve() for t in topics.ALL if not t.is_occasional}
    assert always - sensors - viewers == set(names) - {topics.STABILITY.resolve()}


def test_series_are_arrays_over_time(log_file):
    series = RunLog.open(log_file).series(topics.ODOMETRY)
    assert series.position.shape == (61, 3)
    assert series.pose_covariance.shape == (61, 6, 6)
    assert series.time[-1] == 3.0
    assert series.stamps.dtype == np.int64
    with pytest.raises(AttributeError, match="no field 'velocity' in position, quaternion"):
        _ = series.velocity


def test_the_namespace_is_found(tmp_path):
    write_log(tmp_path / "run.mcap", Known(duration=0.2, namespace="fleet/auv1"))
    log = RunLog.open(tmp_path / "run.mcap")
    assert log.namespace == "fleet/auv1"
    assert "/fleet/auv1/ground_truth/odometry" in log.topics
    assert "/clock" in log.topics
    assert len(log.signals(topics.ODOMETRY)) == 5


def test_invalid_messages_are_left_out_and_counted(tmp_path):
    with LogWriter(tmp_path / "a.mcap") as log:
        signals = SignalWriter(log, (), ())
        for k, value in enumerate((1.0, float("nan"), 3.0)):
            signals.write(topics.WRENCH_COMMAND, Wrench(k * 10**9, np.full(6, value)))
    log = RunLog.open(tmp_path / "a.mcap")
    assert log.series(topics.WRENCH_COMMAND).wrench[:, 0].tolist() == [1.0, 3.0]
    assert log.rejected == {
        "wrench_command": ["1.000 s: wrench_command: wrench.force.x is nan; it must be finite"]
    }


def test_a_topic_that_is_not_there_is_named(log_file):
    with pytest.raises(
        LogError, match=r"has no topic /sensors/imu; it has /allocation, /applied_thrust"
    ):
        RunLog.open(log_file).series(topics.IMU)


def test_one_topic_has_one_type(tmp_path):
    with LogWriter(tmp_path / "a.mcap") as log:
        log.write(
            "/a", "std_msgs/msg/String", "", 0, codec("std_msgs/msg/String").encode({"data": ""})
        )
        with pytest.raises(LogError, match="/a is std_msgs/msg/String, not std_msgs/msg/Empty"):
            log.write("/a", "std_msgs/msg/Empty", "", 0, b"")


def test_a_log_that_cannot_be_written_says_why(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match="cannot be written"):
        LogWriter(tmp_path / "file" / "run.mcap")


WRITER = """
import sys
import numpy as np
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.writer import LogWriter
from uvms_core import topics
from uvms_core.signals import Wrench

log = LogWriter(sys.argv[1])
log.attach("config.yaml", "seed: 3")
log.metadata("uvms", {"seed": 3})
signals = SignalWriter(log, (), ())
rng = np.random.default_rng(0)
k = 0
while True:
    signals.write(topics.WRENCH_COMMAND, Wrench(k * 50_000_000, rng.normal(size=6)))
    k += 1
    if k % 100 == 0:
        print(k, flush=True)
"""


def test_a_writer_killed_in_mid_write_loses_only_the_open_chunk(tmp_path):
    path = tmp_path / "run.mcap"
    process = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE, text=True
    )
    while int(process.stdout.readline()) < 3000:
        pass
    process.send_signal(signal.SIGKILL)
    printed = 3000
    for line in process.stdout:
        printed = int(line)
    assert process.wait() == -signal.SIGKILL
    log = RunLog.open(path)
    assert log.fault == "the writer was stopped early, or the end of the file is damaged"
    assert log.text("config.yaml") == "seed: 3"
    stamps = [wrench.stamp for wrench in log.signals(topics.WRENCH_COMMAND)]
    assert stamps == [k * 50_000_000 for k in range(len(stamps))]
    # A message takes about 111 bytes of a chunk.
    assert len(stamps) >= printed - CHUNK_SIZE // 100
    recovery = recover(path, tmp_path / "whole.mcap")
    assert recovery.message_count == len(stamps)
    whole = RunLog.open(tmp_path / "whole.mcap")
    assert whole.fault == ""
    assert whole.run == {"seed": "3"}
    assert len(whole.signals(topics.WRENCH_COMMAND)) == len(stamps)
    with AnyReader([tmp_path / "whole.mcap"]) as reader:
        assert reader.message_count == len(stamps)


def test_full_chunks_are_on_disk_before_the_log_is_closed(tmp_path):
    log = LogWriter(tmp_path / "a.mcap", chunk_size=1000)
    signals = SignalWriter(log, (), ())
    for k in range(103):
        signals.write(topics.WRENCH_COMMAND, Wrench(k, np.full(6, float(k))))
    count = len(RunLog.open(tmp_path / "a.mcap").signals(topics.WRENCH_COMMAND))
    assert 93 <= count < 103
    log.close()
    assert len(RunLog.open(tmp_path / "a.mcap").signals(topics.WRENCH_COMMAND)) == 103


@pytest.mark.parametrize("keep", [0.9, 0.5, 0.1, 0.0])
def test_a_truncated_log_gives_the_chunks_that_are_whole(tmp_path, keep):
    wrench_log(tmp_path / "a.mcap", 2000, chunk_size=8192)
    data = (tmp_path / "a.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: max(int(keep * len(data)), 60)])
    log = RunLog.open(tmp_path / "cut.mcap")
    assert log.fault == "the writer was stopped early, or the end of the file is damaged"
    stamps = [stamp for _, stamp, _ in log.raw()]
    assert stamps == [k * 50_000_000 for k in range(len(stamps))]
    # The index at the end takes its share of the bytes.
    assert (keep - 0.1) * 2000 < len(stamps) < (keep + 0.1) * 2000


@pytest.mark.parametrize("lost", [1, 8, 300])
def test_a_log_without_its_end_still_has_every_message(tmp_path, lost):
    wrench_log(tmp_path / "a.mcap", 500)
    data = (tmp_path / "a.mcap").read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[:-lost])
    log = RunLog.open(tmp_path / "cut.mcap")
    assert log.fault == "the writer was stopped early, or the end of the file is damaged"
    assert len(log.signals(topics.WRENCH_COMMAND)) == 500


def test_a_damaged_chunk_is_left_out(tmp_path):
    wrench_log(tmp_path / "a.mcap", 2000, chunk_size=8192)
    data = bytearray((tmp_path / "a.mcap").read_bytes())
    with (tmp_path / "a.mcap").open("rb") as file:
        place = make_reader(file).get_summary().chunk_indexes[7]
    data[place.chunk_start_offset + place.chunk_length // 2] ^= 0xFF
    (tmp_path / "bad.mcap").write_bytes(data)
    log = RunLog.open(tmp_path / "bad.mcap")
    assert log.fault.startswith(
        "its data do not match their checksum; 1 of its chunks are damaged and left out"
    )
    assert 1850 < len(log.signals(topics.WRENCH_COMMAND)) < 2000


@pytest.mark.parametrize("content", [b"", b"hello", b"hello, this is not a log"])
def test_other_files_are_refused(tmp_path, content):
    (tmp_path / "a.mcap").write_bytes(content)
    with pytest.raises(LogError, match="is not an MCAP file"):
        RunLog.open(tmp_path / "a.mcap")


def test_a_missing_log_is_named(tmp_path):
    with pytest.raises(LogError, match=r"nothing.mcap: cannot be read: No such file or directory"):
        RunLog.open(tmp_path / "nothing.mcap")


def test_a_log_is_not_recovered_into_itself(log_file):
    with pytest.raises(LogError, match="cannot be recovered into itself"):
        recover(log_file, Path(os.path.relpath(log_file)))


def test_a_path_comes_back_exactly():
    rng = np.random.default_rng(2)
    goal = PathGoal(np.arange(3) / 7.0, rng.normal(size=(3, 3)), np.empty((0, 4)))
    back = path_from_json(path_to_json(goal))
    np.testing.assert_array_equal(back.times, goal.times)
    np.testing.assert_array_equal(back.positions, goal.positions)
    assert back.orientations.shape == (0, 4)
    pointing = replace(
        goal, tool_axis=np.eye(3)[2], axis_directions=rng.normal(size=(3, 3)), time_scale_max=2.0
    )
    back = path_from_json(path_to_json(pointing))
    np.testing.assert_array_equal(back.tool_axis, pointing.tool_axis)
    np.testing.assert_array_equal(back.axis_directions, pointing.axis_directions)
    assert back.time_scale_max == 2.0


def test_a_path_of_an_older_log_asks_for_no_axis():
    old = '{"times": [0, 1], "positions": [[0, 0, 1], [0, 0, 2]], "orientations": []}'
    goal = path_from_json(old)
    assert (goal.tool_axis.shape, goal.axis_directions.shape) == ((0,), (0, 3))
    assert goal.time_scale_max == 1.0


@pytest.mark.parametrize("text", ["{", "[]", '{"times": [0], "positions": [[1, 2]]}'])
def test_malformed_paths_are_refused(text):
    with pytest.raises(LogError, match=r"path\.json: is not a path of the end effector"):
        path_from_json(text)
