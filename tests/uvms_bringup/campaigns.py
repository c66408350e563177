"""A small campaign and its rows, for tests that run it in different ways."""

import json
import os
import subprocess
import sys
from pathlib import Path

from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.plan import runs, variants
from uvms_bringup.campaign.row import without_timings
from uvms_bringup.campaign.runner import CampaignRunner
from uvms_bringup.campaign.table import TABLE_FILE, read_table, write_table
from uvms_bringup.campaign.worker import make_row

SMALL = """
description: Short runs that hold the pose.
scenario: hover
set: {duration_s: 2.0}
draw:
  vehicle.hull.cg_m.2: {uniform: [0.010, 0.014]}
require: {roll_deg.max: {max: 3.0}}
cases:
  still:
    seeds: 3
    set: {plant.current_ned_m_s: [0.0, 0.0, 0.0]}
    baselines: {observer off: {control.observer: false}}
  current:
    seeds: [7, 4]
    vary: {plant.current_ned_m_s: {slow: [0.05, 0.05, 0.0]}}
    require: {roll_deg.max: {max: 0.001}}
"""
"""Eight runs; those in the current do not keep their bound."""


def write(folder, text=SMALL, name="small.yaml"):
    path = folder / name
    path.write_text(text)
    return path


def alone(file, folder):
    """The table of a campaign whose runs are made one by one in this process."""
    rows = [make_row(run, folder, "none") for run in runs(variants(load_campaign(str(file))))]
    write_table(folder / TABLE_FILE, rows)
    return table(folder)


def conducted(file, folder, **options):
    """The table of a campaign that is run as its command runs it."""
    results, stopped = CampaignRunner(**options).run(load_campaign(str(file)), folder, "test")
    assert stopped is None
    return results, table(folder)


def table(folder):
    """Rows without what depends on the machine's speed."""
    return [without_timings(row) for row in read_table(folder / TABLE_FILE)]


def journal_rows(folder):
    """Rows that a campaign has computed so far."""
    path = folder / "rows.jsonl"
    lines = path.read_bytes().splitlines() if path.exists() else []
    return [json.loads(line) for line in lines[1:]]


def start(*words, **options):
    """The program `uvms` in a process of its own."""
    command = [sys.executable, "-m", "uvms_bringup.entry", *map(str, words)]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=dict(os.environ),
        start_new_session=True, **options,
    )  # fmt: skip


def children_of(process: int) -> list[int]:
    """Process ids of what a process has started."""
    found = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == process:
            found.append(int(stat.parent.name))
    return found
