"""The gate's decisions and counts."""

import pytest

from uvms_observer.navigation.innovation_gate import ROW, InnovationGate, Tally, quantile

SECOND = 1_000_000_000


def judge(gate, tally, stamp, distance):
    """The tally after a residual of this squared distance, and whether it was taken."""
    taken = []

    def correct(limit):
        taken.append(distance <= limit)
        return distance

    return gate.apply(tally, stamp, correct), taken[0]


@pytest.mark.parametrize(("size", "limit"), [(1, 3.841458820694124), (3, 7.814727903251179)])
def test_the_limit_is_the_quantile_of_chi_square(size, limit):
    assert InnovationGate(size, 0.95).limit == pytest.approx(limit)


def test_likely_samples_are_taken_and_unlikely_ones_kept_out():
    gate = InnovationGate(3, 0.95)
    tally, likely = judge(gate, Tally(), 0, 7.0)
    tally, unlikely = judge(gate, tally, SECOND, 9.0)
    assert (likely, unlikely) == (True, False)
    assert tally == Tally(accepted=1, gated=1, row=1, since=SECOND, used=0, distance=7.0)


def test_a_distance_that_is_not_a_number_is_kept_out():
    tally, taken = judge(InnovationGate(3, 0.95), Tally(), 0, float("nan"))
    assert (tally.gated, taken) == (1, False)


def test_however_often_a_sample_beyond_the_gate_is_not_taken():
    gate, tally = InnovationGate(1, 0.95), Tally()
    for k in range(10_000):
        tally, taken = judge(gate, tally, k * SECOND, 100.0)
        assert not taken
    assert tally == Tally(gated=10_000, row=10_000, since=0)


def test_an_excluded_sensor_comes_back_when_it_agrees_well():
    gate, tally = InnovationGate(1, 0.9999), Tally()
    for k in range(ROW):
        assert not tally.excluded
        tally, _ = judge(gate, tally, k, 100.0)
    assert tally.excluded
    edge = 0.5 * (quantile(1, 0.95) + gate.limit)
    tally, taken = judge(gate, tally, SECOND, edge)
    assert not taken
    tally, taken = judge(gate, tally, 2 * SECOND, 1.0)
    assert taken
    assert not tally.excluded
    tally, taken = judge(gate, tally, 3 * SECOND, edge)
    assert taken
