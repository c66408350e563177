"""A run that is summed up from memory comes out as the one that is read from its log."""

import json

import pytest

from uvms_bringup.campaign.row import TIMINGS
from uvms_bringup.campaign.single import summary_of
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import SUMMARY_FILE, prepare
from uvms_core.errors import UvmsError

DIFFERENT = "plant.mismatch={mass: 0.2, damping: 0.2, buoyancy_centre_m: 0.001}"
PUSH = "events=[{at_s: 1, until_s: 2, wrench: {force_n: [5, 0, 0], moment_nm: [0, 0, 0]}}]"

THIRSTY = "plant.vehicle_overrides={electrical.hotel_load_w: 100.0}"
SILENT = "events=[{at_s: 1, until_s: 2, sensor: dvl, fault: silent}]"


def flat(summary):
    groups = {name.split(".")[0] for name in TIMINGS} | {"run_id", "start_up_s"}
    return {key: value for key, value in summary.items() if key not in groups}


@pytest.mark.parametrize(
    ("name", "settings", "duration", "outcome"),
    [
        ("hover", [], 2.0, "completed"),
        ("hover", ["plant.current_ned_m_s=[2.5,0,0]"], 6.0, "given up"),
        ("manipulation", [], 3.0, "completed"),
        ("arm_swing", ["control.enabled=false", "vehicle.hull.cg_m.2=0.0101"], 3.0, "completed"),
        ("arm_swing", ["vehicle=bluerov2_alpha5"], 2.0, "completed"),
        ("hover", [DIFFERENT, PUSH], 2.0, "completed"),
        ("hover", [SILENT], 3.0, "completed"),
        ("hover", [THIRSTY, "plant.battery_charge=0.20001"], 2.0, "completed"),
    ],
)
def test_the_summary_from_memory_is_that_of_the_log(tmp_path, name, settings, duration, outcome):
    scenario = load_scenario(name, settings, duration_s=duration)
    made = prepare(scenario, str(tmp_path / "run"), "lockstep", "test").run_simulation()
    assert flat(summary_of(scenario)) == flat(made)
    assert made["outcome"] == outcome
    stored = json.loads((tmp_path / "run" / SUMMARY_FILE).read_text())
    assert flat(json.loads(json.dumps(summary_of(scenario)))) == flat(stored)


def test_a_run_that_cannot_begin_raises():
    scenario = load_scenario("hover", ["vehicle.hull.mass_kg=-1"])
    with pytest.raises(UvmsError, match=r"hull\.mass_kg"):
        summary_of(scenario)
