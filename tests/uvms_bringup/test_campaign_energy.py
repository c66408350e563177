"""Energy and battery are figures that a campaign can require."""

import pytest
from campaigns import write

from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.plan import runs, variants
from uvms_bringup.campaign.worker import make_row

TEXT = """
description: What a hover takes.
scenario: hover
set: {duration_s: 3.0}
seeds: 1
require: {energy.hotel_wh: {min: 0.0499, max: 0.0501}, battery.used: {max: 1.0e-4}}
cases:
  frugal: {require: {energy.total_wh: {max: 0.1}, energy.thrusters_wh.main: {max: 0.05}}}
  too much: {require: {energy.total_wh: {max: 0.05}}}
  almost empty:
    set: {plant.battery_charge: 1.0e-5}
    require: {energy.hotel_wh: {max: 0.04}, battery.left: {equals: 0.0}, battery.used: null}
"""


@pytest.fixture(scope="module")
def rows(tmp_path_factory):
    folder = tmp_path_factory.mktemp("campaign")
    campaign = load_campaign(str(write(folder, TEXT)))
    return {run.case: make_row(run, folder, "none") for run in runs(variants(campaign))}


def test_energy_is_required_and_judged(rows):
    assert rows["frugal"]["passed"], rows["frugal"]["failed"]
    assert rows["frugal"]["energy.hotel_wh"] == pytest.approx(60.0 * 3.0 / 3600.0)
    assert rows["too much"]["failed"][0].startswith("energy.total_wh is 0.05")


def test_a_battery_that_runs_empty_ends_the_energy_and_is_an_event(rows):
    row = rows["almost empty"]
    assert not [text for text in row["failed"] if "energy" in text or "battery" in text], row
    # It is known to a second when it ran empty.
    assert 0.0 <= row["energy.total_wh"] - 3000.0 * 1e-5 < row["energy.power_max_w"] / 3600.0
    assert row["events"][-1]["text"].startswith("battery: empty")
    assert row["errors_first_s.plant"] == 3.0
