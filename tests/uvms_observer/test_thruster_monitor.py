"""Thruster health from synthetic wrenches, whose thrusts, faults and disturbances are known."""

import numpy as np
import pytest

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix
from uvms_observer.health import ThrusterMonitor

DT = 0.05
SIGMA = np.array([0.7, 1.2, 1.2, 0.03, 0.3, 0.3])
"""N and N m: what the sensors of the reference vehicle leave in a tick, by its mass matrix."""
CALM, ALL = np.zeros(6), np.empty(0)
VEHICLES = ("reference_auv", "bluerov2_alpha5")


class Water:
    """A vehicle whose unexplained wrench is made by the equation that the monitor assumes.

    Thrusts lag behind their commands by an integration of its own, in steps of a hundredth.
    """

    def __init__(self, name: str, seed: int = 1) -> None:
        self.vehicle = load_vehicle(name)
        self.matrix = thruster_matrix(self.vehicle)
        self.m = self.matrix.shape[1]
        self.left = np.ones(self.m)
        self.stuck = np.zeros(self.m)
        self.monitor = ThrusterMonitor(self.vehicle)
        self._rng = np.random.default_rng(seed)
        self._tau = np.array([one.time_constant_s for one in self.vehicle.thrusters])
        self._told, self._given = np.zeros(self.m), np.zeros(self.m)
        self.told_dt = iter(lambda: DT, None)  # what the monitor is told of the time between ticks

    def step(self, command, disturbance=CALM, believed=ALL):
        """One tick under a command (m,), N, and a disturbance (6,)."""
        told, given = np.zeros(self.m), np.zeros(self.m)
        target = self.left * command + self.stuck
        for _ in range(100):
            share = -np.expm1(-0.01 * DT / self._tau)
            self._told += share * (command - self._told)
            self._given += share * (target - self._given)
            told, given = told + 0.01 * self._told, given + 0.01 * self._given
        counted = told if not believed.size else believed * told
        noise = SIGMA * self._rng.standard_normal(6)
        wrench = self.matrix @ (given - counted) + disturbance + noise
        return self.monitor.step(next(self.told_dt), wrench, np.zeros(6), command, believed)

    def moved(self, t):
        """Commands (m,) that move, each in its own way, up to a fifth of the limits."""
        limit = np.array([one.ahead_n for one in self.vehicle.thrusters])
        rates = 0.6 + 0.2 * np.arange(self.m)
        return 0.2 * limit * np.sin(rates * t + np.arange(self.m))


def run(water, start_s, end_s, disturbance=lambda t: np.zeros(6)):
    """Steps of a stretch of time; the health after each."""
    ticks = range(round(start_s / DT), round(end_s / DT))
    return [water.step(water.moved(k * DT), disturbance(k * DT)) for k in ticks]


@pytest.mark.parametrize("name", VEHICLES)
@pytest.mark.parametrize("left", [0.0, 0.5])
def test_each_thruster_is_named_by_its_direction_within_two_seconds(name, left):
    """One that pushes along a single axis has no direction of its own, and takes longer."""
    for i in range(Water(name).m):
        water = Water(name, seed=i)
        has_direction = np.count_nonzero(np.abs(water.matrix[:, i]) > 1e-9) > 1
        run(water, 0.0, 6.0)
        water.left[i] = left
        health = run(water, 6.0, 8.0 if has_direction else 14.0)[-1]
        lost = 1.0 - health.effectiveness
        assert lost.argmax() == i
        assert abs(lost[i] - (1.0 - left)) < max(3.0 * health.sigma[i], 0.25)
        assert np.delete(lost, i) == pytest.approx(0.0)
        assert lost[i] > 2.0 * health.sigma[i]


@pytest.mark.parametrize("jitter", [1e-5, 1e-3, 5e-3])
def test_ticks_that_jitter_or_are_lost_do_not_hide_a_fault(jitter):
    """Stamps of real sensors are not on a grid, and now and then a tick is lost."""
    water, i = Water("reference_auv"), 2
    rng = np.random.default_rng(4)
    told = (2 * DT if k % 20 == 19 else DT + jitter * rng.standard_normal() for k in range(10**6))
    water.told_dt = told
    run(water, 0.0, 6.0)
    water.left[i] = 0.0
    health = run(water, 6.0, 9.0)[-1]
    assert (1.0 - health.effectiveness).argmax() == i
    assert health.effectiveness[i] < 0.3


def test_a_thruster_that_recovers_is_whole_again():
    water = Water("reference_auv")
    run(water, 0.0, 5.0)
    water.left[3] = 0.0
    assert run(water, 5.0, 8.0)[-1].effectiveness[3] < 0.2
    water.left[3] = 1.0
    assert run(water, 8.0, 14.0)[-1].effectiveness == pytest.approx(1.0, abs=0.1)


def test_what_is_believed_does_not_change_what_is_found():
    """The wrench is counted with the believed share; the thrust behind it is the same."""
    water = Water("reference_auv")
    run(water, 0.0, 5.0)
    water.left[3] = 0.0
    run(water, 5.0, 8.0)
    believed = np.ones(water.m)
    believed[3] = 0.0
    for k in range(160, 300):
        health = water.step(water.moved(k * DT), believed=believed)
    assert health.effectiveness[3] == pytest.approx(0.0, abs=0.1)
    assert np.delete(health.effectiveness, 3) == pytest.approx(1.0)


def test_a_stuck_thruster_is_one_that_gives_nothing_of_its_command():
    water = Water("reference_auv")
    run(water, 0.0, 5.0)
    water.left[6], water.stuck[6] = 0.0, 12.0
    health = run(water, 5.0, 7.0)[-1]
    assert health.effectiveness[6] < 0.1
    assert np.delete(health.effectiveness, 6) == pytest.approx(1.0)


def gust(t):
    """250 N abeam within a second, with some roll and yaw."""
    size = np.clip(t - 8.0, 0.0, 1.0)
    return size * np.array([0.0, 250.0, 0.0, 6.0, 0.0, 20.0])


def swell(t):
    """Waves from ahead and abeam."""
    return np.array([30.0, 60.0, 20.0, 2.0, 8.0, 10.0]) * np.sin(0.8 * t + np.arange(6))


def grasp(t):
    """A weight of 10 N in the gripper, one metre to starboard of the bow."""
    return float(t > 8.0) * np.array([0.0, 0.0, 10.0, 10.0, -9.0, 0.0])


@pytest.mark.parametrize("disturbance", [gust, swell, grasp])
@pytest.mark.parametrize("name", VEHICLES)
def test_no_disturbance_is_taken_for_a_fault(name, disturbance):
    water = Water(name)
    assert all((h.effectiveness == 1.0).all() for h in run(water, 0.0, 20.0, disturbance))


@pytest.mark.parametrize("lag", [0.3, 1.0])
def test_thrust_that_follows_a_wave_is_not_taken_for_the_cause(lag):
    """A controller that compensates: command = -disturbance, a little later, on one thruster."""
    water = Water("reference_auv")
    for k in range(400):
        command = water.moved(k * DT)
        command[0] = -40.0 * np.sin(0.8 * (k * DT - lag))
        health = water.step(command, np.array([40.0 * np.sin(0.8 * k * DT), 0, 0, 0, 0, 0]))
        assert (health.effectiveness == 1.0).all()


def test_a_dead_thruster_that_is_not_used_is_not_named():
    water = Water("reference_auv")
    water.left[0] = 0.0
    for k in range(300):
        command = water.moved(k * DT)
        command[0] = 0.0
        health = water.step(command)
    assert (health.effectiveness == 1.0).all()
    assert health.sigma[0] >= 0.2


def test_a_fifth_less_is_not_a_fault():
    water = Water("reference_auv")
    water.left[:] = 0.8
    assert all((h.effectiveness == 1.0).all() for h in run(water, 0.0, 15.0))
