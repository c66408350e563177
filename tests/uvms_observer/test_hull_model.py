"""Thrust tells the velocity where no sensor does: right, honest, and silent where not known."""

from dataclasses import replace

import numpy as np
import pytest
from hull_truth import TICK, Thrusts
from navigation_cases import CRUISE, VEHICLE, dvl, outcome_of
from sensor_truth import Motion, Waves

from uvms_core.signals import Odometry, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationConfig
from uvms_observer.navigation.trust.hull_model import hull_model
from uvms_observer.navigation.trust.hull_motion import HullMotion

POOR = load_vehicle("bluerov2_alpha5")
REST = Motion(Waves((0, 0, 10)), Waves((0.02, -0.03, 0.2)))
SILENT = dvl(lambda sample: None, 20.0)
SPHERE = 3.76


def estimate(motion, t):
    """The truth as an odometry."""
    nu = np.concatenate([motion.velocity(t, np.zeros(3)), motion.omega(t)])
    none = np.eye(6)
    attitude = motion.rotation(t).as_quat()
    return Odometry(to_nanoseconds(t), motion.position(t), attitude, nu, none, none)


@pytest.mark.parametrize("vehicle", [POOR, VEHICLE], ids=lambda each: each.name)
def test_the_model_goes_as_the_motion_that_takes_these_thrusts(vehicle):
    """By inverse dynamics of a motion given by formulas, and forward again, with lag and turns."""
    thrusts, hull = Thrusts(vehicle, CRUISE, unlike=0.0, current=0.0), HullMotion(vehicle)
    for k in range(400):
        now, after = k * TICK, (k + 1) * TICK
        hull.inform(thrusts.allocation(to_nanoseconds(now)))
        hull.note(to_nanoseconds(after), estimate(CRUISE, now))
    told = hull.at(to_nanoseconds(after))
    np.testing.assert_allclose(
        told.velocity, CRUISE.velocity(after, np.zeros(3)), atol=0.02, rtol=0
    )


def test_in_a_current_it_goes_through_the_water_whatever_it_began_with():
    """The hull forgets the velocity over ground with which the model starts."""
    thrusts, hull = Thrusts(POOR, CRUISE, seed=1, unlike=0.0, current=0.3), HullMotion(POOR)
    for k in range(600):
        hull.inform(thrusts.allocation(to_nanoseconds(k * TICK)))
        hull.note(to_nanoseconds((k + 1) * TICK), estimate(CRUISE, k * TICK))
    told = hull.at(to_nanoseconds(30.0))
    apart = CRUISE.rotation(30.0).apply(CRUISE.velocity(30.0, np.zeros(3)) - told.velocity)
    np.testing.assert_allclose(apart[:2], thrusts._current[:2], atol=0.03)


def test_the_offset_may_be_what_a_force_makes_of_the_speed():
    """a u + b u^2 balances thrust: with the unknown force on top the vehicle is faster by std."""
    model = hull_model(POOR, NavigationConfig())
    speed = np.array([0.5, 0.1])
    faster = speed + model.std(speed)
    a, b = model.linear, model.quadratic
    more = a * faster + b * faster**2 - (a * speed + b * speed**2)
    np.testing.assert_allclose(more, model.force)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_poor_unit_keeps_its_place_by_a_hull_that_is_20_percent_unlike(seed):
    """In a current of 0.3 m/s; alone it is off by ten metres."""
    aided = outcome_of(SILENT, seed, POOR, CRUISE, Thrusts(POOR, CRUISE, seed))
    alone = outcome_of(SILENT, seed, POOR, CRUISE)
    assert aided.errors.max() < 0.3 * alone.errors.max()
    assert (aided.distances < SPHERE).mean() > 0.99


def test_a_tactical_unit_does_not_need_it():
    """Bit for bit as without."""
    aided = outcome_of(SILENT, 1, VEHICLE, CRUISE, Thrusts(VEHICLE, CRUISE, 1))
    alone = outcome_of(SILENT, 1, VEHICLE, CRUISE)
    np.testing.assert_array_equal(aided.errors, alone.errors)


class Told(Thrusts):
    """Allocations that do not tell what the thrusters do."""

    how = staticmethod(lambda allocation: None)

    def allocation(self, stamp):
        return self.how(super().allocation(stamp))


def broken(allocation):
    share = np.ones(len(allocation.thrust))
    share[1] = 0.4
    return replace(allocation, effectiveness=share)


def old(allocation):
    return replace(allocation, stamp=max(0, allocation.stamp - to_nanoseconds(1.0)))


@pytest.mark.parametrize("how", [lambda allocation: None, broken, old], ids=["no", "broken", "old"])
def test_without_thrusts_that_are_known_the_top_speed_remains(how):
    """No allocation, one that tells of a broken thruster, one that is too old."""
    thrusts = Told(POOR, CRUISE, 1)
    thrusts.how = how
    told = outcome_of(SILENT, 1, POOR, CRUISE, thrusts)
    alone = outcome_of(SILENT, 1, POOR, CRUISE)
    np.testing.assert_array_equal(told.errors, alone.errors)


def from_then_on(begin, end, force):
    """A force (3,) that grows between two times."""
    return lambda t: np.clip((t - begin) / (end - begin), 0.0, 1.0) * np.array(force)


@pytest.mark.parametrize(
    "pull",
    [
        from_then_on(20.0, 20.1, [7.0, 7.0, 0.0]),
        from_then_on(15.0, 35.0, [10.0, 0.0, 0.0]),
        from_then_on(20.0, 30.0, [-40.0, 0.0, 0.0]),
        from_then_on(20.0, 21.0, [-40.0, 0.0, 0.0]),
        from_then_on(-2.0, -1.0, [-40.0, 0.0, 0.0]),
    ],
    ids=["pulled", "pulled ever harder", "held", "held at once", "held all the time"],
)
def test_it_is_honest_where_something_else_holds_the_vehicle(pull):
    """A tether's 10 N; and 40 N of thrust, which would make 1.3 m/s, on a vehicle that is held."""
    outcome = outcome_of(SILENT, 1, POOR, REST, Thrusts(POOR, REST, 1, pull=pull))
    assert (outcome.distances < SPHERE).mean() > 0.99
