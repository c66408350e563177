"""The gate's decisions and counts."""

import pytest

from uvms_observer.navigation.innovation_gate import InnovationGate, Tally

SECOND = 1_000_000_000


class Measurement:
    """A residual of this squared distance that remembers whether it was taken."""

    def __init__(self, distance):
        self.distance, self.taken, self.factor = distance, False, 1.0

    def correct(self, limit):
        distance = self.distance / self.factor
        self.taken = distance <= limit
        return distance

    def widen(self, factor):
        self.factor = factor


def judge(gate, tally, stamp, distance):
    measurement = Measurement(distance)
    return gate.apply(tally, stamp, measurement.correct, measurement.widen), measurement


@pytest.mark.parametrize(("size", "limit"), [(1, 3.841458820694124), (3, 7.814727903251179)])
def test_the_limit_is_the_quantile_of_chi_square(size, limit):
    assert InnovationGate(size, 0.95, 1.0).limit == pytest.approx(limit)


def test_likely_samples_are_taken_and_unlikely_ones_kept_out():
    gate = InnovationGate(3, 0.95, 5.0)
    tally, likely = judge(gate, Tally(), 0, 7.0)
    tally, unlikely = judge(gate, tally, SECOND, 9.0)
    assert (likely.taken, unlikely.taken) == (True, False)
    assert tally == Tally(accepted=1, gated=1, recovered=0, since=0)


def test_a_distance_that_is_not_a_number_is_kept_out():
    tally, measurement = judge(InnovationGate(3, 0.95, 5.0), Tally(), 0, float("nan"))
    assert (tally.gated, measurement.taken) == (1, False)


def test_after_the_timeout_the_covariance_is_widened_and_the_sample_taken():
    gate, tally = InnovationGate(1, 0.95, 2.0), Tally()
    for k in range(5):
        tally, measurement = judge(gate, tally, k * SECOND // 2, 100.0)
    assert measurement.factor == pytest.approx(100.0 / gate.limit)
    assert measurement.taken
    assert tally == Tally(accepted=1, gated=4, recovered=1, since=2 * SECOND)


def test_the_timeout_counts_from_the_last_sample_taken():
    gate = InnovationGate(1, 0.95, 2.0)
    tally, _ = judge(gate, Tally(), 0, 100.0)
    tally, _ = judge(gate, tally, SECOND, 0.5)
    tally, measurement = judge(gate, tally, 2 * SECOND + 1, 100.0)
    assert not measurement.taken
    assert tally == Tally(accepted=1, gated=2, recovered=0, since=SECOND)
