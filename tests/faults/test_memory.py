"""Memory of a run does not grow with its length."""

import subprocess
import sys
import time
from pathlib import Path

import pytest

HOURS = """
import sys
import time
from pathlib import Path
from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_core.signals import to_nanoseconds

def mebibytes():
    pages = int(open("/proc/self/statm").read().split()[1])
    return pages * 4096 / 2**20

hours = float(sys.argv[1])
scenario = load_scenario("hover", [], duration_s=3600.0 * hours)
vehicle = scenario.load_vehicle()
scenario = scenario.for_vehicle(vehicle)
mark = to_nanoseconds(3600.0 * hours / 24.0)
def watch(stamp, _):
    if stamp % mark == 0:
        print(mebibytes(), flush=True)
simulate(scenario, vehicle, scenario.goal.build(vehicle, scenario.plant), progress=watch)
"""
GROWTH_MIB = 6.0
"""What the allocator may still add after the first third of a run, in 6 minutes as in 24 hours."""


@pytest.mark.parametrize(
    "hours",
    [
        pytest.param(0.1, id="6 minutes"),
        pytest.param(24.0, marks=[pytest.mark.long, pytest.mark.timeout(7200)], id="24 hours"),
    ],
)
def test_the_loop_in_process(hours, saw):
    command = [sys.executable, "-c", HOURS, str(hours)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    sizes = [float(line) for line in done.stdout.split()]
    assert len(sizes) == 25
    grown = max(sizes[8:]) - sizes[8]  # kernels that are loaded at their first use come before
    saw(f"{hours:g} simulated hours of `hover` in process", f"{grown:.1f} MiB more memory")
    assert grown < GROWTH_MIB


def family(parent: int) -> dict[int, float]:
    """Resident memory of a process and its children, MiB, by process id."""
    found = {}
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            stat = (entry / "stat").read_text()
            pages = int((entry / "statm").read_text().split()[1])
        except OSError:  # it has ended meanwhile
            continue
        number, ancestor = int(entry.name), int(stat.rpartition(")")[2].split()[1])
        if parent in (number, ancestor):
            found[number] = pages * 4096 / 2**20
    return found


@pytest.mark.parametrize(
    ("seconds", "bound_mib"),
    [
        pytest.param(3600.0, 8.0, marks=[pytest.mark.long, pytest.mark.timeout(3600)], id="1 hour"),
    ],
)
def test_every_process_of_a_graph(seconds, bound_mib, tmp_path, saw):
    command = [sys.executable, "-m", "uvms_bringup.entry", "run", "hover"]
    command += ["--duration", str(seconds), "--output", str(tmp_path / "run")]
    first: dict[int, float] = {}
    last: dict[int, float] = {}
    log = tmp_path / "run" / "run.mcap"
    with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
        began = time.monotonic()
        while process.poll() is None:
            time.sleep(1.0)
            # The summary at the end reads the whole log: what counts is the run before it.
            if not log.exists() or (tmp_path / "run" / "summary.json").exists():
                continue
            if time.monotonic() - began < 60.0:
                first = family(process.pid)
            elif len(now := family(process.pid)) == len(first):
                last = now
    assert process.returncode == 0
    assert last.keys() == first.keys()
    grown = max(last[number] - first[number] for number in first)
    saw(f"graph of {len(first)} processes, {seconds:g} simulated seconds", f"{grown:.1f} MiB more")
    assert grown < bound_mib
