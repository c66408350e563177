"""Lines keep their peaks and gaps where they are thinned, and are the same numbers after it."""

import numpy as np
import pytest
from report_data import numbers

from uvms_analysis.report.samples import POINTS, Times, kept, with_gaps


@pytest.mark.parametrize("count", [1, 2, POINTS, POINTS + 1, 18_041, 100_003])
def test_thinning_keeps_ends_extremes_and_order(count):
    values = np.random.default_rng(count).normal(size=count)
    index = kept(values)
    assert len(index) <= POINTS
    assert np.all(np.diff(index) > 0)
    assert index[0] == 0
    assert index[-1] == count - 1
    assert values[index].min() == values.min()
    assert values[index].max() == values.max()


def test_a_single_peak_anywhere_is_kept():
    for place in (1, 5_000, 18_039):
        values = np.zeros(18_041)
        values[place] = -1.0
        assert place in kept(values)


def test_a_gap_of_the_log_stays_a_gap_through_thinning():
    time = np.arange(0.0, 900.0, 0.05)
    time = time[(time < 300.0) | (time > 310.0)]
    times, values = with_gaps(time, np.sin(time))
    (gap,) = np.flatnonzero(np.isnan(values))
    assert 300.0 < times[gap] < 310.0
    assert gap in kept(values)
    steady, same = with_gaps(time[:1000], np.sin(time[:1000]))
    assert len(steady) == len(same) == 1000


def test_a_stretch_without_any_value_is_empty_and_no_more():
    values = np.where(np.arange(20_000) < 10_000, np.nan, 1.0)
    index = kept(values)
    assert np.isnan(values[index[index < 10_000]]).all()
    assert (values[index[index >= 10_000]] == 1.0).all()


@pytest.mark.parametrize("count", [100, 18_041, 70_000])
def test_what_the_page_reads_are_samples_as_recorded(count):
    time = 0.05 * np.arange(count)
    values = np.cumsum(np.random.default_rng(1).normal(size=count))
    times = Times()
    line = times.line(time, values)
    assert times.line(time, -values)["times"] == line["times"] == 0
    assert len(times.encoded) == 1
    all_times = numbers(times.encoded[0], "f8")
    assert np.array_equal(all_times, time)
    index = numbers(line["index"], line["kind"]) if "index" in line else np.arange(count)
    assert np.array_equal(numbers(line["values"], "f4"), values[index].astype("f4"))


def test_the_size_of_a_line_does_not_grow_with_the_run():
    line = Times().line(0.05 * np.arange(18_041), np.sin(np.arange(18_041)))
    assert sum(len(str(part)) for part in line.values()) < 33_000
