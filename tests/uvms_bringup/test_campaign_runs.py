"""Campaigns on real clusters: the same table whatever computes it, and nothing is lost."""

import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress

import pytest
from campaigns import SMALL, alone, children_of, conducted, journal_rows, start, table, write

from uvms_bringup.campaign.cluster import PATIENCE_S, Cluster
from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.plan import runs, variants
from uvms_bringup.campaign.table import TABLE_FILE, write_table
from uvms_bringup.campaign.worker import make_row
from uvms_bringup.cli import main
from uvms_bringup.errors import CampaignError

SLOW_DEATH_S = 60.0
"""How long a program may take to do what it is waited for, on a busy machine."""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return write(tmp_path_factory.mktemp("campaign"))


@pytest.fixture(scope="module")
def expected(file, tmp_path_factory):
    """What the runs come to one by one, without dask."""
    return alone(file, tmp_path_factory.mktemp("alone"))


@pytest.fixture(scope="module")
def finished(file, tmp_path_factory):
    """A campaign that was run to its end on two workers: its folder, results and table."""
    folder = tmp_path_factory.mktemp("finished")
    return folder, *conducted(file, folder, workers=2)


def wait_for(condition, what):
    began = time.monotonic()
    while not condition():
        assert time.monotonic() - began < SLOW_DEATH_S, what
        time.sleep(0.02)


def test_the_rows_are_those_of_the_runs_alone(expected, finished):
    _, results, found = finished
    assert found == expected
    assert len(found) == 8
    assert [row["passed"] for row in found] == [True] * 6 + [False] * 2
    assert found[6]["failed"][0].startswith("roll_deg.max is 0.")
    assert (results.passed, len(results.judged)) == (3, 5)


@pytest.mark.parametrize("workers", [1, 4])
def test_the_number_of_workers_does_not_matter(file, expected, tmp_path, workers):
    assert conducted(file, tmp_path, workers=workers)[1] == expected


@pytest.fixture
def scheduler():
    """The address of a scheduler in a process of its own, with two workers in theirs."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    address = f"tcp://127.0.0.1:{port}"
    own = ["--host", "127.0.0.1", "--port", str(port), "--no-dashboard"]
    one = [address, "--nthreads", "1", "--no-nanny", "--no-dashboard"]
    programs = [("scheduler", own), ("worker", one), ("worker", one)]
    started = [
        subprocess.Popen(
            [sys.executable, "-m", f"distributed.cli.dask_{name}", *words],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for name, words in programs
    ]
    wait_for(lambda: _listens(port), "the scheduler")
    yield address
    for process in started:
        process.terminate()
    for process in started:
        with suppress(subprocess.TimeoutExpired):
            process.wait(10)
        process.kill()
        process.wait()


def _listens(port):
    with suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
        return True
    return False


def test_a_scheduler_elsewhere_gives_the_same(file, expected, tmp_path, scheduler):
    assert conducted(file, tmp_path, scheduler=scheduler)[1] == expected


def test_the_run_of_a_killed_worker_is_made_again(file, expected, tmp_path):
    order = [run.key for run in runs(variants(load_campaign(str(file))))]
    made = runs(variants(load_campaign(str(file))))
    with Cluster(2) as cluster:
        pids = list(cluster.call(os.getpid).values())
        rows = []
        for row in cluster.rows(made, tmp_path, "none", lambda: None):
            if not rows:
                os.kill(pids[0], signal.SIGKILL)
            rows.append(row)
        assert pids[0] not in cluster.call(os.getpid).values()
    write_table(tmp_path / TABLE_FILE, sorted(rows, key=lambda row: order.index(_key(row))))
    assert table(tmp_path) == expected


def _key(row):
    return row["case"], row["seed"]


def test_a_campaign_that_is_stopped_and_killed_goes_on(file, expected, tmp_path):
    words = ["campaign", file, "--workers", "1", "--output", tmp_path / "out"]
    first = start(*words)
    wait_for(lambda: journal_rows(tmp_path / "out"), "the first row")
    first.send_signal(signal.SIGINT)
    out, err = first.communicate(timeout=SLOW_DEATH_S)
    assert first.returncode == 130, err
    assert re.search(r"stopped by SIGINT: \d of 8 made; go on with --resume", err)
    kept = table(tmp_path / "out")
    assert 0 < len(kept) < 8
    assert re.search(r"\d of 5 runs are made; \d of these kept all that is required", out)

    second = start(*words, "--resume")
    wait_for(lambda: len(journal_rows(tmp_path / "out")) > len(kept), "another row")
    workers = children_of(second.pid)
    assert workers
    second.kill()
    second.communicate(timeout=SLOW_DEATH_S)
    before = journal_rows(tmp_path / "out")
    assert len(kept) < len(before) < 8
    with (tmp_path / "out" / "rows.jsonl").open("a") as journal:
        journal.write('{"case": "still", "se')  # as a process that is killed leaves it

    _, found = conducted(file, tmp_path / "out", workers=1, resume=True)
    assert found == expected
    after = {(row["case"], row["seed"]): row for row in journal_rows(tmp_path / "out")}
    for row in before:  # not made again: even their timings are the same
        assert after[row["case"], row["seed"]] == row
    wait_for(lambda: not any(map(_is_alive, workers)), "the end of the killed campaign's workers")


def _is_alive(process):
    return os.path.exists(f"/proc/{process}")


def test_a_row_made_again_alone_is_the_same(finished, tmp_path, capsys):
    folder, _, _ = finished
    words = ["simulate", "--again", str(folder), "still/observer off", "2"]
    assert main([*words, "--output", str(tmp_path / "again")]) == 0
    _, err = capsys.readouterr()
    assert "the same as the row of the campaign in every field but its timings" in err
    assert (tmp_path / "again" / "run.mcap").is_file()


def test_a_row_that_is_not_the_same_is_told(finished, tmp_path, capsys):
    folder, _, _ = finished
    other = tmp_path / "campaign"
    other.mkdir()
    (other / "campaign.yaml").write_text((folder / "campaign.yaml").read_text())
    lines = (folder / "rows.jsonl").read_text().replace('"roll_deg.rms": 0.', '"roll_deg.rms": 1.')
    (other / "rows.jsonl").write_text(lines)
    words = ["simulate", "--again", str(other), "still", "2"]
    assert main([*words, "--output", str(tmp_path / "again")]) == 0
    assert re.search(
        r"warning: not the same .*\n  roll_deg.rms: 1\.\d+ in", capsys.readouterr().err
    )


def test_a_finished_campaign_is_not_run_again(file, finished, tmp_path):
    folder, _, rows = finished
    with pytest.raises(CampaignError, match="holds a campaign already; go on with it by --resume"):
        conducted(file, folder)
    before = journal_rows(folder)
    assert conducted(file, folder, resume=True)[1] == rows
    assert journal_rows(folder) == before


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        ("max: 3.0", "max: 2.0", "require.roll_deg.max.max was 3.0, is 2.0"),
        ("seeds: 3", "seeds: 4", "cases.still.seeds was 3, is 4"),
        ("  current:", "  more: {}\n  current:", "cases.more is new"),
    ],
)
def test_another_campaign_does_not_go_on_in_the_folder(finished, tmp_path, old, new, text):
    folder, _, _ = finished
    changed = write(tmp_path, SMALL.replace(old, new, 1))
    with pytest.raises(CampaignError, match="begun with other values") as fault:
        conducted(changed, folder, resume=True)
    assert text in str(fault.value)


def test_a_changed_scenario_does_not_go_on_in_the_folder(tmp_path):
    scenario = tmp_path / "mine.yaml"
    scenario.write_text("duration_s: 1.0\n")
    file = write(tmp_path, "scenario: mine.yaml\n")
    conducted(file, tmp_path / "out")
    scenario.write_text("duration_s: 1.5\n")
    with pytest.raises(CampaignError, match="vehicle of case 'run' has changed since the campaign"):
        conducted(file, tmp_path / "out", resume=True)


def test_an_unreachable_scheduler_is_named_before_anything_else(file, tmp_path):
    """Even one that takes connections and never says a word, for which dask waits for ever."""
    assert PATIENCE_S < 10.0
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(CampaignError, match=re.escape(address)):
            conducted(file, tmp_path / "a", scheduler=address)
    with pytest.raises(CampaignError, match="this is no address: missing port number"):
        conducted(file, tmp_path / "b", scheduler="nowhere")
    assert not (tmp_path / "a").exists()


@pytest.mark.parametrize("answer", [b"SSH-2.0-server\r\n", b""])
def test_another_program_is_not_taken_for_a_slow_scheduler(file, tmp_path, answer):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()

        def greet():
            with suppress(OSError):
                while True:
                    with other.accept()[0] as one:
                        one.sendall(answer)

        threading.Thread(target=greet, daemon=True).start()
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        with pytest.raises(CampaignError, match="what answers there is no dask scheduler") as fault:
            conducted(file, tmp_path / "a", scheduler=address)
    assert f"within {PATIENCE_S:g} s" not in str(fault.value)


def test_a_run_that_raises_is_a_row_with_its_reason(tmp_path):
    file = write(
        tmp_path,
        "scenario: hover\nset: {duration_s: 1.0}\nseeds: 40\n"
        "draw: {duration_s: {choice: [0.5, 2000000]}}",
    )
    made = list(runs(variants(load_campaign(str(file)))))
    bad = next(run for run in made if run.values["duration_s"] > 1.0)
    row = make_row(bad, tmp_path, "none")
    assert (row["outcome"], row["passed"]) == ("error", False)
    assert "duration_s: Input should be less than or equal to 1000000" in row["reasons"][0]


def test_logs_of_failed_runs_are_kept(file, tmp_path):
    conducted(file, tmp_path, workers=1, select="current*", logs="failed")
    found = sorted(path.parent.name for path in (tmp_path / "logs").glob("*/run.mcap"))
    assert found == [f"current[plant.current_ned_m_s=slow]-{seed}" for seed in (4, 7)]
