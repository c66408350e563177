"""A payload on a small plant: noticed, weighed, let go of, and never made up."""

import numpy as np
import pytest
from small_plant import PERIOD, SmallPlant, steered

from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.loader import vehicle_from_data
from uvms_dynamics import build_model, inverse_dynamics, restoring_wrench
from uvms_dynamics.payload import with_payload
from uvms_observer import CombinedObserver, ObserverConfig

VEHICLE = load_vehicle()
MASS, WEIGHT, PLACE = 1.3, 5.0, np.array([0.03, -0.02, 0.1])
GRASP, RELEASE = 8.0, 16.0
OUT = np.radians([-60.0, 0.0, 10.0, 0.0])
ACROSS = np.radians([60.0, 20.0, 40.0, 0.0])
NOISE = np.repeat([3e-4, 9e-5], 3)
QUIET = ObserverConfig()


class Handled:
    """A plant in which things happen, with the noise of navigation and encoders.

    Args:
        happen: by time, what is done to the plant.
    """

    def __init__(self, happen, vehicle=VEHICLE, seed=1, noise=1.0):
        self.plant, self.happen = SmallPlant(vehicle), dict(happen)
        self.rng, self.noise = np.random.default_rng(seed), noise
        self.observer, self.achieved = CombinedObserver(vehicle, QUIET), None

    def sense(self):
        odometry, joints = self.plant.odometry(), self.plant.joints()
        odometry.nu[:] += self.noise * NOISE * self.rng.standard_normal(6)
        odometry.twist_covariance[:] = np.diag((self.noise * NOISE) ** 2)
        n = self.plant.n
        joints.position[:] += self.noise * np.radians(0.005) * self.rng.standard_normal(n)
        joints.velocity[:] += self.noise * np.radians(0.02) * self.rng.standard_normal(n)
        return odometry, joints

    def run(self, seconds, goal=ACROSS):
        """Budgets of every tick, the arm drawn out and from half of the run on to the goal."""
        budgets, spoil = [], None
        for tick in range(round(seconds / PERIOD)):
            t = tick * PERIOD
            for due in [each for each in self.happen if each <= t]:
                spoil = self.happen.pop(due)(self.plant) or spoil
            budgets.append(self.observer.step(*self.sense(), self.achieved)[0])
            n = self.plant.n
            thrust, effort, self.achieved = steered(self.plant, (OUT if t < 7.0 else goal)[:n])
            gravity = self.weightless()
            self.plant.step(spoil(thrust) if spoil else thrust, effort + gravity)
        return budgets

    def weightless(self):
        """Torques that carry the arm and what it holds, so that the plain law moves it."""
        still, n = np.zeros(6), self.plant.n
        q = self.plant.x[13 : 13 + n]
        none = np.zeros(n)
        needed = inverse_dynamics(self.plant.model, self.plant.x[3:7], still, still, q, none, none)
        return needed[6:]


def hold(mass=MASS, weight=WEIGHT, place=PLACE):
    def grasp(plant):
        plant.model = with_payload(build_model(plant.vehicle), mass, weight, place)

    return grasp


def let_go(plant):
    plant.model = build_model(plant.vehicle)


def pull(wrench):
    def begin(plant):
        plant.push += np.array(wrench)

    return begin


def kill(index):
    def begin(plant):
        def dead(thrust):
            return np.where(np.arange(len(thrust)) == index, 0.0, thrust)

        return dead

    return begin


@pytest.fixture(scope="module")
def grasped():
    return Handled({GRASP: hold(), RELEASE: let_go}).run(20.0)


def at(budgets, t):
    return budgets[round(t / PERIOD)]


def test_a_grasp_is_noticed_within_a_second_and_so_is_the_release(grasped):
    held = [budget.payload.held for budget in grasped]
    assert not any(held[: round(GRASP / PERIOD)])
    assert all(held[round((GRASP + 1.0) / PERIOD) : round(RELEASE / PERIOD)])
    assert not any(held[round((RELEASE + 1.0) / PERIOD) :])


def test_weight_mass_and_place_are_found(grasped):
    found = at(grasped, RELEASE).payload
    assert found.weight == pytest.approx(WEIGHT, rel=0.02)
    # The mass hardly shows in this motion, and noise in the acceleration pulls it towards zero.
    assert found.mass == pytest.approx(MASS, rel=0.5)
    across, along = np.hypot(*(found.position - PLACE)[:2]), found.position[2] - PLACE[2]
    assert across < 0.01
    assert abs(along) < 0.05  # the tool hardly tilts


def test_the_errors_are_as_large_as_stated(grasped):
    found = at(grasped, RELEASE).payload
    assert abs(found.weight - WEIGHT) < 4.0 * found.weight_sigma
    assert abs(found.mass - MASS) < 4.0 * found.mass_sigma
    assert (np.abs(found.position - PLACE) < 4.0 * found.position_sigma).all()
    assert found.weight_sigma < 0.02 * WEIGHT


def test_what_is_held_is_part_of_the_model_and_not_external(grasped):
    budget = at(grasped, RELEASE)
    assert np.abs(budget.external[3:]).max() < 0.1
    assert abs(budget.external[2]) < 0.5
    bare = restoring_wrench(build_model(VEHICLE), np.array([0.0, 0.0, 0.0, 1.0]), ACROSS)
    assert budget.restoring[2] - bare[2] == pytest.approx(WEIGHT, rel=0.05)


def test_after_the_release_nothing_is_left_over(grasped):
    assert np.abs(grasped[-1].external[3:]).max() < 0.2


@pytest.mark.parametrize("weight", [-4.0, 1.0, 12.0])
def test_light_heavy_and_buoyant_payloads(weight):
    mass = 2.5 * abs(weight) / 9.81
    budgets = Handled({GRASP: hold(mass, weight)}).run(14.0)
    found = budgets[-1].payload
    assert found.held
    assert found.weight == pytest.approx(weight, rel=0.05, abs=0.1)


MADE_UP = {
    "nothing": {},
    "a push": {GRASP: lambda plant: plant.push.__iadd__([0.0, 8.0, 0.0, 0.0, 0.0, 3.0]) is None},
    "a pull down": {
        GRASP: lambda plant: plant.push.__iadd__([0.0, 0.0, 5.0, 1.0, -2.0, 0.0]) is None
    },
    "a dead vertical thruster": {GRASP: kill(5)},
    "held from the start": {0.0: hold()},
}


@pytest.mark.parametrize("case", MADE_UP)
def test_no_payload_is_made_up(case):
    budgets = Handled(MADE_UP[case]).run(14.0)
    assert not any(budget.payload.held for budget in budgets)


def test_a_slow_change_is_not_a_payload():
    """As of a current that sets in."""
    rig = Handled({})
    rig.happen = dict.fromkeys(np.arange(6.0, 12.0, PERIOD), _drift)
    assert not any(budget.payload.held for budget in rig.run(14.0))


def _drift(plant):
    plant.push += np.array([0.02, 0.06, 0.04, 0.01, 0.0, 0.02])


def test_without_torques_of_the_drives_nothing_is_confirmed():
    rig = Handled({GRASP: hold()})
    plain = rig.plant.joints
    rig.plant.joints = lambda: _without_effort(plain())
    assert not any(budget.payload.held for budget in rig.run(12.0))


def _without_effort(joints):
    joints.effort[:] = 0.0
    return joints


def test_an_arm_of_two_joints():
    data = VEHICLE.model_dump()
    for name in ("joints", "links", "stowed_deg"):
        data["arm"][name] = data["arm"][name][:2]
    data["arm"]["postures_deg"] = {}
    budgets = Handled({GRASP: hold()}, vehicle_from_data(data)).run(12.0)
    assert budgets[-1].payload.held
    assert budgets[-1].payload.weight == pytest.approx(WEIGHT, rel=0.05)
