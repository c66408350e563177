"""Gradient and matrix of the cost against finite differences; values against other kernels."""

from dataclasses import replace

import numpy as np
from whole_path_rig import CIRCLE, problem_of

from uvms_dynamics import coupling_wrench, restoring_wrench
from uvms_planner.constraints import free_attitude
from uvms_planner.segment import Samples, reference
from uvms_planner.whole_path import CostWeights, assembly
from uvms_planner.whole_path.barrier import multiplier, penalty
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import Iteration, moved
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.sample import ATTITUDE

BREAKS = np.linspace(0.0, 60.0, 13)


def some_motion(seed: int = 3, weights: CostWeights | None = None, **words):
    """A discrete problem and coefficients that go about within and beyond limits."""
    problem = problem_of({**CIRCLE, **words})
    problem = replace(problem, weights=weights or problem.weights)
    discrete = discretise(problem, BREAKS)
    held = np.tile(problem.start.value, (len(discrete.grid.numbers), 1))
    noise = 0.1 * np.random.default_rng(seed).standard_normal(held.shape)
    return discrete, discrete.complete(held + noise)


def gradient_and_band(discrete, coefficients, mu=1e-2, price=10.0):
    point = Iteration(discrete, coefficients, price)
    band = np.empty((discrete.unknowns, assembly.FUNCTIONS * discrete.problem.size))
    gradient = assembly.linearise(
        *discrete.arguments(), mu, price, coefficients, point._memory, point._row_memory, band
    )
    return gradient, band, lambda c: point.cost(mu, c)


def assert_gradient_is_right(discrete, coefficients):
    gradient, _, cost = gradient_and_band(discrete, coefficients)
    scale = np.abs(gradient).max()
    for index in np.random.default_rng(4).integers(0, discrete.unknowns, 25):
        step = np.zeros(discrete.unknowns)
        step[index] = 1e-6
        up, down = (cost(moved(discrete, coefficients, s)) for s in (step, -step))
        assert abs((up - down) / 2e-6 - gradient[index]) < 1e-4 * scale


def test_gradient_is_that_of_the_cost():
    assert_gradient_is_right(*some_motion())


def test_gradient_with_a_prescribed_orientation():
    assert_gradient_is_right(*some_motion(keep_orientation=True))


def test_gradient_with_an_axis_that_points_somewhere():
    words = {"orientation": "axis", "tool_axis": [0.6, 0.0, 0.8]}
    discrete, coefficients = some_motion(**words)
    assert discrete.wishes.turn > 0.0
    assert_gradient_is_right(discrete, coefficients)


def test_gradient_near_singular_postures():
    discrete, coefficients = some_motion(weights=CostWeights(singular=100.0, manipulability=1.0))
    assert discrete.wishes.singular == 100.0
    assert_gradient_is_right(discrete, coefficients)


def test_gradient_with_an_end_that_is_given():
    discrete, coefficients = some_motion()
    problem = replace(discrete.problem, end=discrete.problem.start)
    discrete = discretise(problem, BREAKS)
    assert_gradient_is_right(discrete, discrete.complete(coefficients))


def test_matrix_is_positive():
    _, band, _ = gradient_and_band(*some_motion())
    size, width = band.shape
    full = np.zeros((size, size))
    for column in range(size):
        for offset in range(min(width, size - column)):
            full[column + offset, column] = full[column, column + offset] = band[column, offset]
    values = np.linalg.eigvalsh(full)
    assert values[0] > -1e-9 * values[-1]


def test_penalty_has_its_slope_and_curvature():
    for g in (-3.0, -0.1, -1e-3, 0.0, 1e-3, 0.5):
        value, slope, curvature = penalty(g, 1e-2, 5.0)
        up, down = penalty(g + 1e-6, 1e-2, 5.0)[0], penalty(g - 1e-6, 1e-2, 5.0)[0]
        np.testing.assert_allclose((up - down) / 2e-6, slope, rtol=1e-4)
        np.testing.assert_allclose(
            (multiplier(g + 1e-6, 1e-2, 5.0) - multiplier(g - 1e-6, 1e-2, 5.0)) / 2e-6,
            curvature, rtol=1e-3, atol=1e-5,
        )  # fmt: skip
        assert 0 < slope < 5.0
        assert np.isfinite(value)


def test_values_are_those_of_the_reference_that_is_sent():
    discrete, coefficients = some_motion()
    plan = PathPlan(discrete.problem, discrete.knots, coefficients, 0)
    times = np.linspace(1.0, 59.0, 7)
    values, model = plan.values(times), discrete.problem.model
    samples = plan.sample(times)
    assert isinstance(samples, Samples)
    sent = reference(model, 0, times, samples)
    for k in range(len(times)):
        restoring = restoring_wrench(model, sent.quaternion[k], sent.q[k])
        coupling = coupling_wrench(
            model, sent.nu[k], sent.nu_dot[k], sent.q[k], sent.q_dot[k], sent.q_ddot[k]
        )
        np.testing.assert_allclose(values[k, :6], restoring, atol=1e-9)
        np.testing.assert_allclose(values[k, 6:12], coupling, atol=1e-9)
        np.testing.assert_allclose(
            values[k, ATTITUDE : ATTITUDE + 2], free_attitude(model, sent.q[k]), atol=1e-9
        )
