"""The kernel of the usual inertial samples against the steps that it stands for."""

import numpy as np
import pytest
from nav_states import NOISE, random_state
from sensor_truth import NONE

from uvms_core.signals import ImuSample
from uvms_observer.navigation.inertial.at_once import packed, take_inertial
from uvms_observer.navigation.measurements.imu import correct_attitude
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.trust.innovation_gate import InnovationGate

RATE, FORCE = np.array([0.1, -0.2, 0.3]), np.array([0.4, -0.3, -9.6])
STEP = np.array([0.01, 0.0, 0.0])
VARIANCE = np.array([1e-4, 1e-4, 4e-4])
MEAN = np.array([1.0, -2.0, 0.5, 0.0, 0.0, 0.0])
PERIOD = 10_000_000  # ns
JUMPS = 0.02, 0.0, 0.1, 0.0
WEIGHTS = InnovationGate(3, 0.99, 1e-9 * PERIOD).weights
OPEN = 1e9


def samples(count, **changed):
    """Rates that go up by STEP at each; the last one with other values."""
    made = [
        {
            "stamp": (k + 1) * PERIOD,
            "quaternion": random_state(1).quaternion,
            "angular_velocity": RATE + (k + 1) * STEP,
            "linear_acceleration": FORCE,
        }
        for k in range(count)
    ]
    made[-1] |= changed
    return [ImuSample(*each.values(), NONE, NONE, NONE) for each in made]


def taken(state, given, gate=OPEN):
    return take_inertial(
        *(tuple(state), *packed(given), 0, 0, RATE, FORCE, *JUMPS),
        *(9.81, *NOISE, VARIANCE, gate, 7.0, 1.5, MEAN, *WEIGHTS),
    )


def stepped(state, given, gate=OPEN):
    """The same one by one; the distances."""
    rate, force, distances = RATE, FORCE, []
    for each in given:
        after = each.angular_velocity, each.linear_acceleration
        propagate(tuple(state), rate, after[0], force, after[1], 0.01, 9.81, *NOISE)
        distances.append(correct_attitude(tuple(state), each.quaternion, VARIANCE, gate))
        rate, force = after
    return distances


def assert_same(ours, theirs):
    for one, other in zip(ours, theirs, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("count", [1, 5])
def test_it_is_propagations_and_corrections_in_one(count):
    ours, theirs, given = random_state(1), random_state(1), samples(count)
    done, fits, total, level, mean = taken(ours, given)
    distances = stepped(theirs, given)
    assert_same(ours, theirs)
    assert (done, fits) == (count, True)
    assert total == pytest.approx(7.0 + sum(distances))
    assert mean.shape == MEAN.shape
    size, keep, new = WEIGHTS
    expected = 1.5
    for distance in distances:
        expected += new * (distance / size - expected)
    assert level == pytest.approx(expected)
    if count == 1:
        told = theirs.innovation[0, :3] / theirs.innovation[2, :3]
        np.testing.assert_allclose(mean[:3], keep * MEAN[:3] + np.sqrt(1.0 - keep**2) * told)


def test_an_attitude_beyond_the_gate_ends_the_run_and_corrects_nothing():
    ours, theirs, given = random_state(1), random_state(1), samples(3)
    done, fits, total, _, mean = taken(ours, given, 1e-9)
    stepped(theirs, given[:1], 1e-9)
    assert_same(ours, theirs)
    assert (done, fits, total) == (1, False, 7.0)
    np.testing.assert_array_equal(mean, MEAN)


@pytest.mark.parametrize(
    "odd",
    [
        {"linear_acceleration": FORCE + 0.2},
        {"angular_velocity": RATE - 0.1},
        {"stamp": 10 * PERIOD},
    ],
    ids=["force", "rate", "gap"],
)
@pytest.mark.parametrize("count", [1, 3])
def test_a_reading_that_is_not_usual_is_left_to_the_screen(odd, count):
    ours, theirs, given = random_state(1), random_state(1), samples(count, **odd)
    done, fits, *_ = taken(ours, given)
    stepped(theirs, given[:-1])
    assert (done, fits) == (count - 1, True)
    assert_same(ours, theirs)
