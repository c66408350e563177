"""Energy that the plant takes and what is left of its battery, against closed forms."""

import numpy as np
import pytest
from scipy.integrate import quad

from uvms_core import topics
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.electrical import Battery
from uvms_dynamics.power import PowerDraw
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.battery import BatteryPack
from uvms_dynamics.simulation.events.thruster import ThrusterEvent
from uvms_dynamics.simulation.publication import plant_outputs

VEHICLE = load_vehicle()
HOTEL, DENSITY = VEHICLE.electrical.hotel_load_w, VEHICLE.environment.water_density_kg_m3
NO_TORQUE = np.zeros(VEHICLE.n_joints)


def plant(vehicle=VEHICLE, events=(), **config):
    return Plant(vehicle, PlantConfig(**config), 1, events)


def fly(plant, seconds, thrust=(), torque=NO_TORQUE):
    """The plant after a while under constant commands; returns the battery's samples."""
    command = np.zeros(VEHICLE.n_thrusters)
    command[: len(thrust)] = thrust
    samples = []
    for _ in range(round(seconds / 0.05)):
        stamp = plant.stamp
        plant.step(ThrusterCommand(stamp, command), JointCommand(stamp, np.array(torque)))
        if (said := plant.truth().battery) is not None:
            samples.append(said)
    return samples


def test_at_rest_there_is_the_hotel_load_alone():
    own = plant()
    last = fly(own, 10.0)[-1]
    assert own.energy.total == pytest.approx(10.0 * HOTEL, rel=1e-12)
    assert not own.energy.thrusters.any()
    assert last.percentage == pytest.approx(1.0 - 10.0 * HOTEL / 3600.0 / 3000.0, abs=1e-7)
    assert last.current == pytest.approx(-HOTEL / 48.0, rel=1e-6)


@pytest.mark.parametrize("newtons", [30.0, -30.0])
def test_a_constant_thrust_takes_its_power_all_the_time(newtons):
    own = plant()
    fly(own, 5.0, [newtons, 0.5 * newtons])  # until the lag is over
    before = own.energy
    last = fly(own, 4.0, [newtons, 0.5 * newtons])[-1]
    taken = (own.energy.thrusters - before.thrusters) / 4.0
    for k, share in ((0, 1.0), (1, 0.5)):
        expected = VEHICLE.thrusters[k].power.power(share * newtons, DENSITY)
        assert taken[k] == pytest.approx(float(expected), rel=1e-9)
    assert not taken[2:].any()
    assert last.power == pytest.approx(float(taken.sum()) + HOTEL, rel=1e-6)


def test_the_rise_of_a_thrust_is_integrated_as_it_lags():
    """T = T_c (1 - exp(-t / tau)), from rest, below the slew limit."""
    own, drive = plant(), VEHICLE.thrusters[0]
    fly(own, 0.6, [20.0])

    def power(time):
        thrust = 20.0 * (1.0 - np.exp(-time / drive.time_constant_s))
        return float(drive.power.power(thrust, DENSITY))

    assert own.energy.thrusters[0] == pytest.approx(quad(power, 0.0, 0.6)[0], rel=1e-3)


def test_a_joint_takes_what_it_works_and_gives_nothing_back():
    draw = PowerDraw(VEHICLE)
    rates = np.array([[0.5, 0.0, -0.5, 0.2]])
    assert draw.arm(np.array([4.0, 9.0, 4.0, -1.0]), rates) == pytest.approx(2.0 / 0.5)
    own = plant()
    fly(own, 1.0, torque=[2.0, 0.0, 0.0, 0.0])
    kinetic_or_lost = own.energy.arm * VEHICLE.electrical.arm_efficiency
    angle = own.truth().joints.position[0]
    assert angle > 0.0
    assert kinetic_or_lost == pytest.approx(2.0 * angle, rel=1e-3)  # torque times way


def test_thrusters_of_several_kinds_are_told_apart():
    table = {"thrust_n": [-98.0, 0.0, 98.0], "power_w": [500.0, 0.0, 400.0]}
    mixed = load_vehicle(overrides={"thrusters.side_aft.power": {**table, "diameter_m": None,
                                                                 "efficiency": None}})  # fmt: skip
    thrust = np.random.default_rng(1).uniform(-49.0, 49.0, (5, 7))
    found = PowerDraw(mixed).thrusters(thrust)
    for k, thruster in enumerate(mixed.thrusters):
        expected = thruster.power.power(thrust[:, k], DENSITY)
        np.testing.assert_allclose(found[:, k], expected, rtol=1e-12)


def test_what_the_battery_loses_is_what_it_gives_and_what_its_resistance_takes():
    """U q = P t + I^2 R t at a constant open voltage, and no power is had beyond U^2 / 4R."""
    pack = BatteryPack(
        Battery(nominal_voltage_v=20.0, capacity_ah=10.0, internal_resistance_ohm=0.5), 1.0, 0.0
    )
    current = pack.current(150.0)
    assert (20.0 - 0.5 * current) * current == pytest.approx(150.0)
    pack.take(150.0, 600.0)
    lost = 20.0 * (1.0 - pack.share) * 36000.0
    assert lost == pytest.approx((150.0 + 0.5 * current**2) * 600.0)
    assert pack.sample(600 * 10**9).power == pytest.approx(150.0, rel=1e-6)
    assert pack.current(200.0) == pytest.approx(20.0)
    assert pack.current(1e6) == pytest.approx(20.0)


def test_a_falling_voltage_takes_more_charge_for_the_same_energy():
    """With U linear in the charge the energy is the mean voltage times the charge."""
    battery = Battery(
        nominal_voltage_v=14.8, capacity_ah=18.0, full_voltage_v=16.8, empty_voltage_v=12.0
    )
    pack, seconds = BatteryPack(battery, 1.0, 0.0), 3600
    for _ in range(seconds):
        pack.take(100.0, 1.0)
    share = pack.share
    mean = 0.5 * (16.8 + 12.0 + 4.8 * share)
    assert mean * (1.0 - share) * 18.0 == pytest.approx(100.0 * seconds / 3600.0, rel=1e-4)
    assert pack.sample(seconds * 10**9).voltage == pytest.approx(12.0 + 4.8 * share)


def test_the_battery_speaks_once_a_second_and_its_currents_add_up():
    own = plant()
    samples = fly(own, 6.0, [40.0])
    assert [said.stamp for said in samples] == [k * 10**9 for k in range(1, 7)]
    taken = -sum(said.current for said in samples) * 1.0
    assert taken == pytest.approx(own.energy.total / 48.0, rel=1e-6)
    assert plant().truth().battery.current == pytest.approx(-HOTEL / 48.0, rel=1e-6)


def test_the_same_commands_give_the_same_energy():
    one, other = plant(), plant()
    assert fly(one, 2.0, [10.0, -5.0]) == fly(other, 2.0, [10.0, -5.0])
    assert one.energy.total == other.energy.total


def test_an_empty_battery_drives_nothing_and_gives_no_more():
    stuck = ThrusterEvent(at_s=0.0, thruster="side_fore", stuck_at_n=20.0)
    again = ThrusterEvent(at_s=12.0, thruster="main", effectiveness=1.0)
    share = 8.0 * 240.0 / 3600.0 / 3000.0
    own = plant(events=(stuck, again), battery_charge=share)
    fly(own, 5.0, [30.0], [3.0, 0.0, 0.0, 0.0])
    assert own.truth().thrust[:2] == pytest.approx([30.0, 20.0], abs=1e-3)
    fly(own, 10.0, [30.0], [3.0, 0.0, 0.0, 0.0])
    held, taken = own.truth().joints.position, own.energy.total
    fly(own, 5.0, [30.0], [3.0, 0.0, 0.0, 0.0])
    assert own.battery_share == 0.0
    assert own.truth().thrust == pytest.approx(np.zeros(7), abs=1e-6)
    assert own.truth().applied.commanded[0] == 30.0
    assert np.array_equal(own.truth().joints.position, held)  # by the brakes
    assert not own.truth().joints.effort.any()
    assert own.energy.total == taken
    assert taken == pytest.approx(3000.0 * 3600.0 * share, rel=0.02)  # a tick's worth
    texts = [happened.text for happened in own.take_happened()]
    assert f"battery: {100.0 * share:.3g}% left" in texts
    assert "battery: empty; thrusters and joint drives have no power" in texts


def test_a_battery_says_once_that_it_is_low():
    own = plant(battery_charge=0.2 + 1e-5)
    fly(own, 5.0)
    assert [happened.text for happened in own.take_happened()] == ["battery: 20% left"]


def test_a_vehicle_without_data_takes_nothing_known_and_publishes_nothing():
    own = plant(load_vehicle(overrides={"electrical": None}))
    assert fly(own, 1.2, [10.0]) == []
    assert own.energy is None
    assert own.battery_share is None
    published = plant_outputs(own.stamp, own.sense(), own.truth(), [])
    assert topics.BATTERY_STATE not in [topic for topic, _ in published]
    tethered = plant(load_vehicle(overrides={"electrical.battery": None}))
    fly(tethered, 1.0)
    assert tethered.energy.total == pytest.approx(HOTEL)
    assert tethered.truth().battery is None


def test_energy_changes_nothing_else():
    own, bare = plant(), plant(load_vehicle(overrides={"electrical": None}))
    for each in (own, bare):
        fly(each, 3.0, [40.0, 10.0, -10.0], [1.0, 0.0, 0.0, 0.0])
    assert np.array_equal(own.truth().odometry.nu, bare.truth().odometry.nu)
    assert np.array_equal(own.truth().joints.position, bare.truth().joints.position)
