"""Energy of a run from logs whose thrusts, torques and rates are known."""

from dataclasses import replace

import numpy as np
import pytest
from synthetic import Known, write_log

from uvms_analysis.analysis import Analysis
from uvms_analysis.compare.table import unit
from uvms_analysis.energy import battery, electrical_power, energy
from uvms_analysis.errors import LogError
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.summary import summarise
from uvms_core import topics
from uvms_core.signals import AppliedThrust, BatteryState, JointStates, to_nanoseconds
from uvms_core.vehicle import dump_vehicle, load_vehicle

VEHICLE = load_vehicle()
DENSITY = VEHICLE.environment.water_density_kg_m3


def written(path, vehicle=VEHICLE, plant=None, share=lambda time: 0.5 - time / 1024.0):
    """An hour in steps of 10 s: 40 N by the first thruster, a joint at 0.5 rad/s against 4 N m."""
    thrust, rate, effort = np.zeros(7), np.zeros(4), np.zeros(4)
    thrust[0], rate[1], effort[1] = 40.0, 0.5, 4.0
    with LogWriter(path) as log:
        log.attach("vehicle.yaml", dump_vehicle(vehicle))
        if plant is not None:
            log.attach("plant_vehicle.yaml", dump_vehicle(plant))
        signals = SignalWriter(log, vehicle.joint_names, vehicle.thruster_names)
        for time in np.arange(0.0, 3601.0, 10.0):
            stamp = to_nanoseconds(float(time))
            used = AppliedThrust(stamp, thrust, thrust, stamp, stamp, False, False)
            signals.write(topics.APPLIED_THRUST, used)
            joints = JointStates(stamp, np.zeros(4), rate, effort)
            signals.write(topics.TRUE_JOINT_STATES, joints)
            if share is not None:
                left = max(share(time), 0.0)
                said = BatteryState(stamp, 40.0 + left, -1.0, 64.0 * left, 64.0, left)
                signals.write(topics.BATTERY_STATE, said)
    return Analysis(RunLog.open(path))


def test_an_hour_of_constant_power_is_as_many_watt_hours(tmp_path):
    found = energy(written(tmp_path / "run.mcap", share=lambda time: 1.0 - time / 8192.0))
    main = float(VEHICLE.thrusters[0].power.power(40.0, DENSITY))
    arm = 2.0 / VEHICLE.electrical.arm_efficiency
    assert found["thrusters_wh"] == {
        "main": pytest.approx(main),
        **dict.fromkeys(VEHICLE.thruster_names[1:], 0.0),
    }
    assert found["propulsion_wh"] == pytest.approx(main)
    assert found["arm_wh"] == pytest.approx(arm)
    assert found["hotel_wh"] == pytest.approx(60.0)
    assert found["total_wh"] == pytest.approx(main + arm + 60.0)
    for name in ("power_mean_w", "power_max_w"):
        assert found[name] == pytest.approx(main + arm + 60.0), name


def test_an_empty_battery_gives_nothing(tmp_path):
    run = written(tmp_path / "run.mcap", share=lambda time: 0.5 - time / 2048.0)
    power = electrical_power(run)
    assert not power.total[power.time >= 1024.0].any()
    assert power.total[power.time < 1024.0].min() > 60.0
    found = battery(run)
    assert found["left"] == 0.0
    assert found["used"] == 0.5
    # Half of it lasted 1024 s, and the sample after that says so; the rest of the hour counts not.
    assert found["lasts_h"] == pytest.approx(2.0 * 1030.0 / 3600.0)


def test_what_the_battery_says_of_its_use(tmp_path):
    found = battery(written(tmp_path / "run.mcap", share=lambda time: 1.0 - time / 8192.0))
    assert found["used"] == pytest.approx(3600.0 / 8192.0)
    assert found["left"] == pytest.approx(1.0 - 3600.0 / 8192.0)
    assert found["lasts_h"] == pytest.approx(8192.0 / 3600.0)
    assert found["least_voltage_v"] == pytest.approx(40.0 + found["left"])
    unused = battery(written(tmp_path / "idle.mcap", share=lambda time: 1.0))
    assert unused["used"] == 0.0
    assert unused["lasts_h"] is None


def test_the_plants_own_vehicle_counts(tmp_path):
    thirsty = load_vehicle(overrides={"electrical.hotel_load_w": 100.0})
    assert energy(written(tmp_path / "run.mcap", plant=thirsty))["hotel_wh"] < 100.0  # it is empty
    full = written(tmp_path / "full.mcap", plant=thirsty, share=None)
    assert energy(full)["hotel_wh"] == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("overrides", "why_energy", "why_battery"),
    [
        ({"electrical": None}, "has no section `electrical`", "has no section `electrical`"),
        ({"thrusters.main.power": None}, "gives no `power` of main", "gives no `power` of main"),
        ({"electrical.battery": None}, None, "the vehicle file gives no `electrical.battery`"),
        ({}, None, "the log has no battery_state, although the vehicle has a battery"),
    ],
)
def test_what_is_not_known_says_why(tmp_path, overrides, why_energy, why_battery):
    run = written(tmp_path / "run.mcap", load_vehicle(overrides=overrides), share=None)
    if why_energy is None:
        assert energy(run)["total_wh"] > 60.0
    else:
        with pytest.raises(LogError, match=why_energy):
            energy(run)
    with pytest.raises(LogError, match=why_battery):
        battery(run)


def test_the_summary_has_figures_for_campaigns_and_reasons(tmp_path):
    write_log(tmp_path / "run.mcap", replace(Known(), duration=4.0))
    found = summarise(tmp_path / "run.mcap", wall_s=None)
    assert found["energy"]["total_wh"] == pytest.approx(
        found["energy"]["propulsion_wh"] + found["energy"]["hotel_wh"]
    )
    assert found["battery"]["used"] == pytest.approx(4.0 / 1024.0)
    assert "energy" not in found["missing"]


def test_units_of_a_comparison():
    units = {
        "energy.total_wh": "Wh",
        "energy.power_max_w": "W",
        "energy.thrusters_wh.main": "Wh",
        "battery.lasts_h": "h",
        "battery.used": "",
    }
    assert {name: unit(name) for name in units} == units
