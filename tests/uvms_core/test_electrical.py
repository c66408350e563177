"""What the vehicle file says of power and battery: laws, published figures, refusals, messages."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import BatteryState as Message

from uvms_core import topics
from uvms_core.battery import LOW, battery_status
from uvms_core.cdr import codec
from uvms_core.diagnostics import ERROR, OK, WARN, together
from uvms_core.errors import SignalError, VehicleFileError
from uvms_core.messages import from_message, to_message
from uvms_core.signals import BatteryState
from uvms_core.vehicle import load_vehicle, vehicle_warnings
from uvms_core.vehicle.scaled import scaled_data
from uvms_core.vehicle.thruster_power import ThrusterPower

DISC = ThrusterPower(diameter_m=0.2, efficiency=0.4)
TABLE = ThrusterPower(thrust_n=(-10.0, 0.0, 10.0, 20.0), power_w=(30.0, 2.0, 20.0, 60.0))
BATTERY = {"nominal_voltage_v": 14.8, "capacity_ah": 18.0}


def refusal(**overrides):
    changes = {path.replace("__", "."): value for path, value in overrides.items()}
    with pytest.raises(VehicleFileError) as fault:
        load_vehicle(overrides=changes)
    return str(fault.value)


@pytest.mark.parametrize("density", [997.0, 1025.0])
def test_an_ideal_disc_gives_its_thrust_the_speed_of_its_wake(density):
    """T = m_dot w and P = m_dot w^2 / 2 with m_dot = rho A w / 2, w far behind the disc."""
    wake, area = 1.7, math.pi * 0.1**2
    flow = density * area * wake / 2.0
    power = DISC.power(flow * wake, density)
    assert power == pytest.approx(0.5 * flow * wake**2 / 0.4)


def test_a_disc_takes_the_same_both_ways_and_nothing_at_rest():
    thrust = np.linspace(0.0, 50.0, 7)
    assert np.array_equal(DISC.power(thrust, 1025.0), DISC.power(-thrust, 1025.0))
    assert DISC.power(0.0, 1025.0) == 0.0
    assert DISC.power(8.0, 1025.0) == pytest.approx(8.0 * DISC.power(2.0, 1025.0))


def test_a_table_is_interpolated_and_goes_on_with_the_law_of_the_disc():
    assert TABLE.power([-10.0, -5.0, 0.0, 5.0, 15.0], 1.0) == pytest.approx([30, 16, 2, 11, 40])
    assert TABLE.power([80.0, -40.0], 1.0) == pytest.approx([60.0 * 8.0, 30.0 * 8.0])
    assert TABLE.power([[15.0], [80.0]], 1.0).shape == (2, 1)


@pytest.mark.parametrize(
    ("thrust", "watts"),
    # Other rows of the maker's table at 16 V, at 1140, 1216, 1360, 1592, 1744 and 1852 us.
    [(-35.85, 309.1), (-24.60, 168.0), (-8.05, 27.2), (5.03, 9.6), (24.69, 118.4), (44.22, 288.0)],
)
def test_the_t200_takes_what_its_maker_measured(thrust, watts):
    thruster = load_vehicle("bluerov2_alpha5").thrusters[3]
    assert thruster.power.power(thrust, 997.0) == pytest.approx(watts, abs=6.0)


def test_a_copy_of_another_size_has_thrusters_of_that_size():
    """Thrust with L^3 and areas with L^2 make the power grow with L^3.5, a table's too."""
    data = load_vehicle("bluerov2_alpha5").model_dump(mode="json")
    data["thrusters"][0]["power"] = {"diameter_m": 0.08, "efficiency": 0.3}
    copy = scaled_data(data, 2.0)
    for own, other in zip(data["thrusters"][:2], copy["thrusters"][:2], strict=True):
        one, two = ThrusterPower(**own["power"]), ThrusterPower(**other["power"])
        assert two.power(8.0 * 20.0, 997.0) == pytest.approx(2**3.5 * one.power(20.0, 997.0))
    battery = copy["electrical"]["battery"]
    assert battery["capacity_ah"] == 8.0 * 18.0
    assert battery["full_voltage_v"] == 16.8
    hotel = data["electrical"]["hotel_load_w"]
    assert copy["electrical"]["hotel_load_w"] == pytest.approx(2**3.5 * hotel)


@pytest.mark.parametrize(
    ("power", "words"),
    [
        ({}, "needs either thrust_n and power_w (a table), or diameter_m and efficiency"),
        ({"diameter_m": 0.1}, "needs either thrust_n and power_w"),
        ({"diameter_m": 0.1, "efficiency": 1.2}, "less than or equal to 1"),
        ({"thrust_n": [0, 1], "power_w": [0]}, "thrust_n has 2 values and power_w 1; needs as"),
        ({"thrust_n": [0, 2, 2], "power_w": [0, 1, 2]}, "must rise; 2 N follows 2 N"),
        ({"thrust_n": [-1, 1], "power_w": [1, 1]}, "thrust_n has no 0 between -1 and 1 N"),
        ({"thrust_n": [-1, 0, 1], "power_w": [1, -2, 1]}, "power_w: -2 W; must be >= 0"),
        (
            {"thrust_n": [-1, 0, 1, 2], "power_w": [1, 0, 3, 2]},
            "power_w goes from 3 to 2 W where thrust_n goes from 1 to 2 N",
        ),
        (
            {"thrust_n": [0, 98], "power_w": [0, 300]},
            "begins at 0 N, and the thruster gives -98 N astern",
        ),
        ({"thrust_n": [-98, 0], "power_w": [300, 0]}, "needs the power ahead as well"),
    ],
)
def test_what_is_no_power_curve_is_refused(power, words):
    whole = {"thrust_n": [], "power_w": [], "diameter_m": None, "efficiency": None, **power}
    assert words in refusal(thrusters__main__power=whole)


@pytest.mark.parametrize(
    ("battery", "words"),
    [
        ({"nominal_voltage_v": 14.8}, "needs capacity_ah or capacity_wh, one of them"),
        ({**BATTERY, "capacity_wh": 266.4}, "needs capacity_ah or capacity_wh, one of them"),
        ({**BATTERY, "capacity_ah": 0.0}, "greater than 0"),
        (
            {**BATTERY, "full_voltage_v": 14.0},
            "nominal_voltage_v: 14.8 V; must be within empty_voltage_v = 14.8 and"
            " full_voltage_v = 14 V",
        ),
        ({**BATTERY, "capasity": 1.0}, "known names here: capacity_ah, capacity_wh"),
    ],
)
def test_what_is_no_battery_is_refused(battery, words):
    assert words in refusal(electrical={"hotel_load_w": 60.0, "battery": battery})


def test_a_vehicle_without_electrical_data_is_as_it_was():
    bare = load_vehicle(overrides={"electrical": None})
    assert bare.battery is None
    assert bare.lacks_power == "the vehicle file has no section `electrical`"
    assert topics.BATTERY_STATE not in topics.of(bare)
    assert topics.BATTERY_STATE not in topics.nodes(bare)[topics.PLANT].outputs
    assert set(topics.ALL) - set(topics.of(bare)) == {topics.BATTERY_STATE}


def test_what_is_given_in_part_is_warned_of_and_not_used():
    partial = load_vehicle(overrides={"thrusters.main.power": None})
    assert partial.lacks_power == "the vehicle file gives no `power` of main"
    assert partial.battery is None
    assert "electrical: the vehicle file gives no `power` of main" in str(vehicle_warnings(partial))
    bare = load_vehicle(overrides={"electrical": None})
    assert "they have `power`, but there is no `electrical`" in str(vehicle_warnings(bare))


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        ("capacity_wh", 5.0, "5 Wh are gone after 5 minutes of the hotel load of 60 W alone"),
        ("internal_resistance_ohm", 1.0, "1 ohm: nearly empty it gives 576 W at most"),
    ],
)
def test_a_battery_that_cannot_do_it_is_warned_of(path, value, words):
    vehicle = load_vehicle(overrides={f"electrical.battery.{path}": value})
    assert words in str(vehicle_warnings(vehicle))


def test_both_capacities_are_the_same_battery():
    one = load_vehicle("bluerov2_alpha5").battery
    other = one.model_copy(update={"capacity_ah": None, "capacity_wh": 18.0 * 14.8})
    assert one.energy_wh == pytest.approx(266.4)
    assert other.charge_ah == pytest.approx(18.0)


STATE = BatteryState(3_500_000_000, 15.5, -2.25, 9.0, 18.0, 0.5)


def test_rclpy_reads_what_is_written_and_the_other_way_round():
    ours = codec(topics.BATTERY_STATE.type)
    data = ours.encode(to_message(topics.BATTERY_STATE, STATE))
    theirs = deserialize_message(data, Message)
    assert (theirs.header.stamp.sec, theirs.header.stamp.nanosec) == (3, 500_000_000)
    assert (theirs.voltage, theirs.current, theirs.percentage) == (15.5, -2.25, 0.5)
    assert theirs.charge == 9.0
    assert theirs.capacity == theirs.design_capacity == 18.0
    assert math.isnan(theirs.temperature)
    assert theirs.present
    assert theirs.power_supply_status == Message.POWER_SUPPLY_STATUS_DISCHARGING
    assert theirs.power_supply_technology == Message.POWER_SUPPLY_TECHNOLOGY_UNKNOWN
    back = from_message(topics.BATTERY_STATE, ours.decode(serialize_message(theirs)))
    assert back == STATE
    assert STATE.power == pytest.approx(15.5 * 2.25)


def test_a_battery_that_knows_its_voltage_alone_is_read():
    nothing = dict.fromkeys(("current", "charge", "capacity", "percentage"), math.nan)
    stamp = SimpleNamespace(stamp=SimpleNamespace(sec=1, nanosec=0), frame_id="")
    found = from_message(
        topics.BATTERY_STATE, SimpleNamespace(header=stamp, voltage=15.0, **nothing)
    )
    assert found.voltage == 15.0
    assert math.isnan(found.percentage)
    nothing["charge"] = math.inf
    with pytest.raises(
        SignalError, match="battery_state: charge is inf; it must be finite, or NaN"
    ):
        from_message(topics.BATTERY_STATE, SimpleNamespace(header=stamp, voltage=15.0, **nothing))
    with pytest.raises(SignalError, match="battery_state: voltage is nan; it must be finite"):
        from_message(
            topics.BATTERY_STATE, SimpleNamespace(header=stamp, voltage=math.nan, **nothing)
        )


def test_a_low_battery_is_a_warning_and_an_empty_one_an_error():
    assert battery_status(None)[0] == battery_status(1.0)[0] == battery_status(LOW)[0] == OK
    assert battery_status(0.15) == (WARN, "battery: 15% left")
    assert battery_status(0.0)[0] == ERROR
    tilted = WARN, "roll 40 deg"
    assert together((OK, "ok"), battery_status(0.5)) == (OK, "ok")
    assert together(tilted, battery_status(0.15)) == (WARN, "roll 40 deg; battery: 15% left")
    assert together(tilted, battery_status(0.0))[0] == ERROR
