"""The tracking filter on polynomials, noise and a random walk of its own kind."""

import numpy as np
import pytest
from scipy.stats import chi2

from uvms_dynamics.tracking import TrackingFilter

DT = 0.05


@pytest.mark.parametrize("channels", [1, 4, 7])
def test_a_constant_acceleration_is_found_without_lag(channels):
    tracker = TrackingFilter(3, 0.3)
    a = np.linspace(-1.0, 1.0, channels)
    for k in range(200):
        t = k * DT
        x = tracker.step(DT, np.array([1.0 + 0.5 * a * t**2, a * t]), np.array([1e-6, 1e-4]))
    np.testing.assert_allclose(x[2], a, atol=1e-6)
    np.testing.assert_allclose(x[1], a * t, atol=1e-6)


def test_a_rate_alone_gives_its_slope_at_irregular_intervals():
    tracker, t = TrackingFilter(2, 0.1), 0.0
    for k in range(300):
        dt = DT * (1 + k % 3)
        t += dt
        x = tracker.step(dt, np.array([[2.0 - 0.3 * t]]), np.array([1e-4]))
    assert x[1, 0] == pytest.approx(-0.3, abs=1e-6)


def test_perfect_measurements_are_followed():
    tracker, t = TrackingFilter(3, 1.0), np.arange(0.0, 10.0, 0.01)
    for s in t:
        x = tracker.step(0.01, np.array([[np.sin(s)], [np.cos(s)]]), np.zeros(2))
    np.testing.assert_allclose(x[:, 0], [np.sin(s), np.cos(s), -np.sin(s)], atol=0.01)


def test_it_is_much_quieter_than_differences_of_the_rate():
    rng, sigma = np.random.default_rng(1), 3.5e-4
    tracker, found, differences, last = TrackingFilter(3, 0.02), [], [], 0.0
    for _ in range(2000):
        rate = sigma * rng.standard_normal()
        measured = np.array([[1e-4 * rng.standard_normal()], [rate]])
        found.append(tracker.step(DT, measured, np.array([1e-8, sigma**2]))[2, 0])
        differences.append((rate - last) / DT)
        last = rate
    assert np.std(found[100:]) < 0.5 * np.std(differences)


def test_its_errors_are_as_large_as_its_covariance_says():
    """Truth: the acceleration is a random walk, as the filter takes it to be."""
    jerk, variances, distances = 0.4, np.array([1e-6, 1e-4]), []
    for seed in range(100):
        rng = np.random.default_rng(seed)
        tracker, x = TrackingFilter(3, jerk), np.array([0.0, 0.0, jerk * rng.standard_normal()])
        fine = DT / 20
        for _ in range(60):
            measured = x[:2] + np.sqrt(variances) * rng.standard_normal(2)
            estimate = tracker.step(DT, measured[:, None], variances)[:, 0]
            error = x - estimate
            for _ in range(20):
                x = x + fine * np.array([x[1], x[2], 0.0])
                x[2] += jerk * np.sqrt(fine) * rng.standard_normal()
        distances.append(error @ np.linalg.solve(tracker.covariance, error))
    low, high = chi2.ppf([0.0005, 0.9995], 300)
    assert low < sum(distances) < high
