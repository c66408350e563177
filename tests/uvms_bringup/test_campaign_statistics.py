"""The statistics of a campaign against published values and closed forms."""

import numpy as np
import pytest
from scipy.optimize import brentq

from uvms_bringup.campaign.bound import Bound
from uvms_bringup.campaign.statistics import Z95, case_statistics, spread, wilson
from uvms_bringup.campaign.table import read_table, write_table


def test_wilson_against_published_intervals():
    """Newcombe (1998), Statistics in Medicine 17, 857-872, table I, method 3."""
    for passed, count, low, high in (
        (81, 263, 0.2553, 0.3662),
        (15, 148, 0.0624, 0.1605),
        (0, 20, 0.0, 0.1611),
        (1, 29, 0.0061, 0.1718),
    ):
        assert wilson(passed, count) == pytest.approx((low, high), abs=5e-5)


@pytest.mark.parametrize(("passed", "count"), [(1, 3), (7, 9), (40, 41), (500, 1000)])
def test_wilson_solves_its_equation(passed, count):
    """The ends are the rates that the observed one is exactly z standard deviations away from."""
    rate = passed / count

    def off(p):
        return (rate - p) ** 2 - Z95**2 * p * (1.0 - p) / count

    expected = brentq(off, 1e-12, rate), brentq(off, rate, 1.0 - 1e-12)
    assert wilson(passed, count) == pytest.approx(expected, abs=1e-9)


def test_wilson_of_nothing_and_of_all():
    assert wilson(0, 0) == (0.0, 1.0)
    low, high = wilson(10, 10)
    assert high == 1.0
    assert low == pytest.approx(10 / (10 + Z95**2))


def rows(values, **more):
    return [
        {"seed": seed, "x": value, "passed": True, "outcome": "completed", **more}
        for seed, value in enumerate(values, start=1)
    ]


def test_spread_has_median_percentile_and_the_seed_of_the_worst():
    values = list(np.arange(1.0, 102.0)[::-1])
    found = spread("x", Bound(max=90.0), rows(values))
    assert (found["median"], found["p95"], found["worst"], found["worst_seed"]) == (51, 96, 101, 1)
    assert found["broken"] == 11
    assert spread("x", Bound(min=0.0), rows(values))["worst_seed"] == 101
    assert spread("x", Bound(min=0.0, max=200.0), rows(values))["worst"] == 1.0


def test_what_is_not_known_is_counted_and_left_out():
    found = spread("x", Bound(max=2.0), rows([None, 1.0, 3.0]))
    assert (found["unknown"], found["median"], found["broken"]) == (1, 2.0, 2)
    assert spread("x", Bound(max=2.0), rows([None]))["worst_seed"] is None
    assert spread("x", Bound(equals="a"), rows(["a", "b", "a"]))["values"] == {"a": 2, "b": 1}


def test_a_case_counts_its_runs():
    found = case_statistics({"x": Bound(max=2.0)}, rows([1.0, 2.0]) + rows([3.0], passed=False))
    assert (found["runs"], found["passed"], found["outcomes"]) == (3, 2, {"completed": 3})
    assert found["wilson_95"] == list(wilson(2, 3))


def test_a_table_keeps_types_and_values(tmp_path):
    given = [
        {"a": 1, "b": 1, "c": True, "d": "x", "e": ["p", "q"], "f": [1.0, 2.0]},
        {"a": 2, "b": 2.5, "c": False, "d": 3, "e": [], "g": None},
    ]
    write_table(tmp_path / "t.parquet", given)
    assert read_table(tmp_path / "t.parquet") == [
        {"a": 1, "b": 1.0, "c": True, "d": "x", "e": ["p", "q"], "f": "[1.0, 2.0]", "g": None},
        {"a": 2, "b": 2.5, "c": False, "d": "3", "e": [], "f": None, "g": None},
    ]
