"""Memory of a run does not grow with its length."""

import subprocess
import sys

import pytest

HOURS = """
import sys
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
GROWTH_MIB = 2.0
"""What the allocator may still add after the first 24th of a run."""


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
    grown = max(sizes[2:]) - sizes[2]
    saw(f"{hours:g} simulated hours of `hover` in process", f"{grown:.1f} MiB more memory")
    assert grown < GROWTH_MIB
