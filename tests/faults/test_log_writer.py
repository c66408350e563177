"""A log is written whole or says why not; what was written so far stays readable."""

import errno
import os
import resource
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from rosbags.rosbag2.reader import Reader

from uvms_analysis.errors import LogError
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.locate import log_path
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.records import UNFINISHED
from uvms_analysis.log.recover import recover
from uvms_analysis.log.writer import CHUNK_SIZE, LogWriter
from uvms_core import topics
from uvms_core.signals import Wrench

PERIOD = 50_000_000


def wrenches(log, count, first=0):
    signals = SignalWriter(log, (), ())
    rng = np.random.default_rng(first)
    for k in range(first, first + count):
        signals.write(topics.WRENCH_COMMAND, Wrench(k * PERIOD, rng.normal(size=6)))


def stamps(path):
    return [stamp for _, stamp, _ in RunLog.open(path).raw()]


def test_times_are_simulated_and_on_the_wall(tmp_path):
    with LogWriter(tmp_path / "run.mcap") as log:
        wrenches(log, 3)
        log.write("/wrench_command", "geometry_msgs/msg/WrenchStamped", "", 7, b"\0" * 100, 42)
    with (tmp_path / "run.mcap").open("rb") as file:
        messages = [m for _, _, m in make_reader(file).iter_messages(log_time_order=False)]
    assert [m.log_time for m in messages] == [0, PERIOD, 2 * PERIOD, 7]
    assert messages[-1].publish_time == 42
    wall = [m.publish_time for m in messages[:3]]
    assert wall == sorted(wall)
    assert wall[0] > 1_700_000_000 * 10**9
    assert [m.sequence for m in messages] == [0, 1, 2, 3]


def test_every_checksum_is_there_and_right(tmp_path):
    with LogWriter(tmp_path / "run.mcap", chunk_size=2000) as log:
        log.attach("config.yaml", "seed: 1")
        wrenches(log, 100)
        log.metadata("uvms", {"seed": 1})
    with (tmp_path / "run.mcap").open("rb") as file:
        kinds = [type(r) for r in StreamReader(file, emit_chunks=True, validate_crcs=True).records]
    data = (tmp_path / "run.mcap").read_bytes()
    assert len(kinds) > 10
    assert data[-12:-8] != b"\0\0\0\0"  # of the summary; the reader compares it only if it is there
    with (tmp_path / "run.mcap").open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert sum(1 for _ in reader.iter_messages(topics=["/wrench_command"])) == 100
        assert [a.name for a in reader.iter_attachments()] == ["config.yaml"]


def test_a_log_is_never_overwritten(tmp_path):
    with LogWriter(tmp_path / "run.mcap") as log:
        wrenches(log, 5)
    before = (tmp_path / "run.mcap").read_bytes()
    with pytest.raises(LogError, match=r"run\.mcap: exists already"):
        LogWriter(tmp_path / "run.mcap")
    assert (tmp_path / "run.mcap").read_bytes() == before
    with LogWriter(tmp_path / "run.mcap", overwrite=True) as log:
        wrenches(log, 2)
    assert len(stamps(tmp_path / "run.mcap")) == 2


def test_the_folder_is_a_bag_of_rosbag2(tmp_path):
    with LogWriter(tmp_path / "run.mcap") as log:
        wrenches(log, 41)
    for name in ("config.yaml", "summary.json"):
        (tmp_path / name).write_text("{}")
    with Reader(tmp_path) as reader:
        assert reader.message_count == 41
        assert reader.duration == 40 * PERIOD + 1
        (connection,) = reader.connections
        assert (connection.topic, connection.msgcount) == ("/wrench_command", 41)
        assert connection.msgtype == "geometry_msgs/msg/WrenchStamped"
        assert sum(1 for _ in reader.messages()) == 41
    (information,) = yaml.safe_load((tmp_path / "metadata.yaml").read_text()).values()
    assert information["version"] == 9
    assert information["relative_file_paths"] == ["run.mcap"]


def test_a_folder_stays_the_bag_of_its_first_log(tmp_path):
    for name in ("run.mcap", "replay.mcap"):
        with LogWriter(tmp_path / name) as log:
            wrenches(log, 3)
    assert "- run.mcap" in (tmp_path / "metadata.yaml").read_text()
    assert log_path(tmp_path) == tmp_path / "run.mcap"
    (tmp_path / "run.mcap").unlink()
    assert log_path(tmp_path / "replay.mcap") == tmp_path / "replay.mcap"
    with LogWriter(tmp_path / "replay.mcap", overwrite=True) as log:
        wrenches(log, 4)
    with Reader(tmp_path) as reader:
        assert reader.message_count == 4
    assert log_path(tmp_path) == tmp_path / "replay.mcap"


def test_a_folder_without_a_log_and_one_with_several_are_named(tmp_path):
    with pytest.raises(LogError, match="holds no single log; name one of its files: none"):
        log_path(tmp_path)
    for name in ("a.mcap", "b.mcap"):
        (tmp_path / name).write_bytes(b"")
    with pytest.raises(LogError, match=r"a\.mcap, b\.mcap"):
        log_path(tmp_path)


FULL = """
import resource, sys
import numpy as np
from uvms_analysis.errors import LogError
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.writer import LogWriter
from uvms_core import topics
from uvms_core.signals import Wrench
import signal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
rng = np.random.default_rng(0)
try:
    with LogWriter(sys.argv[1]) as log:
        log.metadata("uvms", {"seed": 1})
        signals = SignalWriter(log, (), ())
        for k in range(20_000):
            signals.write(topics.WRENCH_COMMAND, Wrench(k * 50_000_000, rng.normal(size=6)))
except LogError as fault:
    print(fault)
"""


@pytest.mark.parametrize("room", [60, 40_000, 300_000])
def test_a_file_that_may_not_grow_ends_in_one_line_and_stays_readable(tmp_path, saw, room):
    path = tmp_path / "run.mcap"
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(path), str(room)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"log {path}: cannot be written: {os.strerror(errno.EFBIG)}\n"
    assert path.stat().st_size <= room
    log = RunLog.open(path)
    assert log.fault == UNFINISHED
    assert log.run == ({"seed": "1"} if room > 200 else {})
    found = stamps(path)
    assert found == [k * PERIOD for k in range(len(found))]
    assert len(found) > (room - 2 * CHUNK_SIZE) // 120
    recover(path, tmp_path / "out" / "run.mcap")
    assert stamps(tmp_path / "out" / "run.mcap") == found
    saw(f"no room after {room} bytes of a log", "LogError with the reason; the rest is readable")


def test_a_full_disk_ends_in_one_line(saw):
    with pytest.raises(LogError, match=r"/dev/full: cannot be written: No space left on device"):
        LogWriter("/dev/full", overwrite=True)
    saw("disk full from the start", "LogError with the reason")


def test_the_index_that_does_not_fit_is_said_by_close(tmp_path):
    path = tmp_path / "run.mcap"
    log = LogWriter(path)
    wrenches(log, 50)
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size + 10, limit[1]))
    try:
        with pytest.raises(LogError, match="cannot be written: File too large"):
            log.close()
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
        signal.signal(signal.SIGXFSZ, handler)
    log.close()  # once more changes nothing
    assert RunLog.open(path).fault == UNFINISHED
    assert not (tmp_path / "metadata.yaml").exists()


def test_an_error_in_the_run_is_not_hidden_by_one_of_the_log(tmp_path):
    def run():
        with LogWriter(tmp_path / "run" / "run.mcap") as log:
            wrenches(log, 3)
            shutil.rmtree(tmp_path / "run")
            raise RuntimeError("of the run")

    with pytest.raises(RuntimeError, match="of the run"):
        run()


def test_a_folder_that_vanished_is_named(tmp_path, saw):
    log = LogWriter(tmp_path / "run" / "run.mcap")
    wrenches(log, 3)
    shutil.rmtree(tmp_path / "run")
    with pytest.raises(LogError, match=r"metadata\.yaml: cannot be written: No such file"):
        log.close()
    saw("the folder of a log is deleted during the run", "LogError that names it")


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(LogError, match="its folder cannot be made: File exists"):
        LogWriter(tmp_path / "file" / "run.mcap")


@pytest.mark.parametrize("stamp", [-1, 2**63])
def test_a_stamp_that_no_log_can_hold_is_refused(tmp_path, stamp):
    with (
        LogWriter(tmp_path / "run.mcap") as log,
        pytest.raises(LogError, match=f"the stamp {stamp} ns cannot be recorded"),
    ):
        log.write("/clock", "rosgraph_msgs/msg/Clock", "", stamp, b"")
    assert RunLog.open(tmp_path / "run.mcap").fault == ""


GROWTH = """
import sys
from uvms_analysis.log.writer import LogWriter

TYPE = "geometry_msgs/msg/WrenchStamped"
NAMES = [f"/topic_{k}" for k in range(20)]

def resident():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096 / 2**20

def write(log, first):
    # 12 simulated minutes as of hover: 20 Hz, 4 kB on 20 topics.
    for k in range(first, first + 14_400):
        stamp = k * 50_000_000
        data = stamp.to_bytes(8, "little") * 25
        for name in NAMES:
            log.write(name, TYPE, "", stamp, data, stamp)

log = LogWriter(sys.argv[1])
write(log, 0)
before = resident()
for number in range(1, 1 + int(sys.argv[2])):
    write(log, 14_400 * number)
print(resident() - before)
log.close()
print(resident() - before)
"""


@pytest.mark.parametrize(
    "fifths", [1, pytest.param(30, marks=pytest.mark.long)], ids=["quick", "six hours"]
)
def test_the_writer_does_not_grow(tmp_path, saw, fifths):
    path, hours = tmp_path / "run.mcap", fifths / 5
    done = subprocess.run(
        [sys.executable, "-c", GROWTH, str(path), str(fifths)], capture_output=True, text=True
    )
    running, closed = map(float, done.stdout.split())
    assert running < 1.0 + 1.5 * hours  # the memory allocator takes some at once
    assert closed < 5.0 + 1.5 * hours  # the indexes are written one after the other
    with path.open("rb") as file:
        statistics = make_reader(file).get_summary().statistics
    assert statistics.message_count == 20 * 14_400 * (fifths + 1)
    path.unlink()
    saw(f"{hours:g} simulated hours in one log", f"the writer grew by {running:.1f} MiB")
