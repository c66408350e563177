"""The gate's decisions and counts."""

import numpy as np
import pytest

from uvms_observer.navigation.trust.innovation_gate import (
    CHANCES,
    ROW,
    InnovationGate,
    Tally,
    quantile,
)

SECOND = 1_000_000_000
PERIOD_S = 0.125
NOISE, EXPECTED = 1.0, 2.0  # std of the measurement's noise, and of its residual


def judge(gate, tally, stamp, residual, expected=EXPECTED):
    """The tally after a residual along one axis, and whether it was taken."""
    taken, innovation = [], np.zeros((3, 6))
    innovation[:, 0] = residual, NOISE, expected
    innovation[1:, 1:] = 1.0

    def correct(limit):
        distance = (residual / expected) ** 2
        taken.append(distance <= limit)
        return distance

    return gate.apply(tally, stamp, correct, innovation), taken[-1]


def gate_of(size, probability):
    return InnovationGate(size, probability, PERIOD_S)


def excluded(gate, residual):
    """The tally of a sensor that has jumped."""
    tally = Tally()
    for k in range(ROW + 5):
        tally, _ = judge(gate, tally, k * SECOND, residual)
    assert tally.excluded
    return tally


@pytest.mark.parametrize(("size", "limit"), [(1, 3.841458820694124), (3, 7.814727903251179)])
def test_the_limit_is_the_quantile_of_chi_square(size, limit):
    assert gate_of(size, 0.95).limit == pytest.approx(limit)


def test_likely_samples_are_taken_and_unlikely_ones_kept_out():
    gate = gate_of(3, 0.95)
    tally, likely = judge(gate, Tally(), 0, 5.0)
    tally, unlikely = judge(gate, tally, SECOND, 6.0)
    assert (likely, unlikely) == (True, False)
    assert tally[:6] == (1, 1, 1, SECOND, 0, 6.25)


def test_a_distance_that_is_not_a_number_is_kept_out():
    tally, taken = judge(gate_of(3, 0.95), Tally(), 0, float("nan"))
    assert (tally.gated, taken) == (1, False)


def test_however_often_a_sample_beyond_the_gate_is_not_taken():
    gate, tally = gate_of(1, 0.95), Tally()
    for k in range(10_000):
        tally, taken = judge(gate, tally, k * SECOND, 20.0)
        assert not taken
    assert (tally.gated, tally.row, tally.since) == (10_000, 10_000, 0)


def test_an_excluded_sensor_that_drifted_away_comes_back_when_it_agrees_well():
    gate = gate_of(1, 0.9999)
    tally = excluded(gate, 4.0 * EXPECTED)
    tally = tally._replace(away=None)  # as of one whose first residual was small
    edge = EXPECTED * np.sqrt(0.5 * (quantile(1, 0.95) + gate.limit))
    tally, taken = judge(gate, tally, 9 * SECOND, edge)
    assert not taken
    tally, taken = judge(gate, tally, 10 * SECOND, 1.0)
    assert taken
    assert not tally.excluded
    tally, taken = judge(gate, tally, 11 * SECOND, edge)
    assert taken


def test_one_that_jumped_does_not_come_back_because_the_estimate_is_uncertain():
    gate = gate_of(1, 0.9999)
    tally = excluded(gate, 20.0)
    for k in range(100):
        tally, taken = judge(gate, tally, (10 + k) * SECOND, 20.0, expected=30.0)
        assert not taken


def test_it_comes_back_by_a_jump_within_some_samples():
    gate = gate_of(1, 0.9999)
    tally = excluded(gate, 20.0)
    tally, taken = judge(gate, tally, 10 * SECOND, 7.5)  # back, though not near enough by chance
    assert not taken
    assert tally.away.chances == CHANCES
    tally, taken = judge(gate, tally, 11 * SECOND, 1.0)
    assert taken
    assert tally.away is None


def test_it_is_believed_when_it_knows_better_whatever_it_was_off_by():
    gate = gate_of(1, 0.9999)
    _, taken = judge(gate, excluded(gate, 20.0), 10 * SECOND, 20.0, expected=61.0)
    assert taken


def test_the_mean_of_white_residuals_has_a_standard_deviation_of_one():
    gate, tally, rng = gate_of(1, 0.9999), Tally(), np.random.default_rng(1)
    means = []
    for k, residual in enumerate(EXPECTED * rng.standard_normal(4000)):
        tally, _ = judge(gate, tally, k, residual)
        means.append(tally.mean[0])
    assert np.std(means) == pytest.approx(1.0, abs=0.15)
    assert tally.level == pytest.approx(1.0, abs=0.4)


def test_a_mean_that_is_off_by_a_little_shows():
    """Half a sigma in each sample, of which the gate sees nothing."""
    gate = InnovationGate(1, 0.9999, 0.01)
    tally, rng = Tally(), np.random.default_rng(2)
    for k, residual in enumerate(EXPECTED * (0.7 + rng.standard_normal(400))):
        tally, _ = judge(gate, tally, k, residual)
    assert tally.mean[0] > 6.0
