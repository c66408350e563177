import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planner_rig import START, solver_of, target_near

from uvms_core.rng import generator
from uvms_planner.evolution import (
    breed,
    cross_over,
    evolve,
    fill_elite,
    mutate,
    roulette,
    selection_fitness,
)
from uvms_planner.fitness import cost, judge
from uvms_planner.methods.genetic import settings as evolution_settings
from uvms_planner.projection import tool_pose
from uvms_planner.refine import refine

SOLVER = solver_of()
SETTINGS = evolution_settings(SOLVER.config.genetic)
STILL = np.zeros(8)


def problem_near(offset, previous=STILL, solver=SOLVER):
    return solver.problem(START, previous, target_near(solver, START, offset))


def test_the_wheel_chooses_in_proportion_to_fitness():
    fitness = np.array([1.0, 0.0, 3.0, 6.0])
    rng = np.random.default_rng(5)
    count = 20000
    hits = np.bincount([roulette(fitness, rng.random()) for _ in range(count)], minlength=4)
    assert hits[1] == 0
    expected = fitness / 10 * count
    spread = np.sqrt(expected * (1 - fitness / 10))
    assert np.all(np.abs(hits - expected) <= 4 * spread)


def test_the_wheel_covers_its_ends_and_a_population_without_fitness():
    assert roulette(np.array([0.0, 2.0, 0.0]), 0.0) == 1
    assert roulette(np.array([0.0, 2.0, 0.0]), np.nextafter(1.0, 0.0)) == 1
    assert roulette(np.zeros(4), 0.6) == 2


def test_fitness_is_one_over_the_cost_and_deb_ranks_the_rest():
    valid = np.array([True, True, True, True, False])
    violation = np.array([0.0, 0.0, 0.01, 0.2, np.inf])
    value = np.array([4.0, 0.5, 1e-9, 1e-9, np.inf])
    fitness = np.zeros(5)
    selection_fitness(valid, violation, value, fitness)
    assert fitness[0] == 0.25
    assert fitness[1] == 2.0
    assert 0.25 > fitness[2] > fitness[3] > 0.0
    assert fitness[4] == 0.0


def test_the_elite_is_the_best_by_deb():
    valid = np.array([True, False, True, True])
    violation, value = np.array([0.1, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 3.0, 2.0])
    elite = np.zeros(4, dtype=np.int64)
    fill_elite(valid, violation, value, elite)
    assert list(elite) == [3, 2, 0, -1]


def test_crossing_over_swaps_the_tails():
    first, second = np.zeros(8, dtype=np.uint8), np.ones(8, dtype=np.uint8)
    cross_over(first, second, 3)
    assert list(first) == [0, 0, 0, 1, 1, 1, 1, 1]
    assert list(second) == [1, 1, 1, 0, 0, 0, 0, 0]


def test_mutation_flips_bits_at_its_rate():
    rng, flipped = np.random.default_rng(1), 0
    for _ in range(500):
        chromosome = np.zeros(128, dtype=np.uint8)
        mutate(chromosome, 0.02, rng)
        flipped += int(np.sum(chromosome))
    expected = 500 * 128 * 0.02
    assert abs(flipped - expected) < 4 * np.sqrt(expected)


def test_the_discarded_have_no_children():
    chromosomes = np.zeros((6, 16), dtype=np.uint8)
    chromosomes[2] = 1  # the only one that may breed
    children = np.zeros_like(chromosomes)
    fitness = np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    quiet = SETTINGS._replace(mutation_rate=0.0)
    breed(chromosomes, fitness, quiet, np.random.default_rng(0), children, 1)
    assert np.all(children[1:] == 1)
    assert np.all(children[0] == 0)


@given(
    seed=st.integers(0, 2**32 - 1),
    offset=st.lists(st.floats(-0.02, 0.02), min_size=3, max_size=3),
    drift=st.lists(st.floats(-1.0, 1.0), min_size=8, max_size=8),
)
@settings(max_examples=40, deadline=None)
def test_it_never_returns_an_individual_off_the_path_or_beyond_a_limit(seed, offset, drift):
    previous = 0.5 * np.array(drift) * SOLVER.limits.reach
    problem = problem_near(offset, previous)
    small = SETTINGS._replace(population=12, generations=4)
    seeds = np.array([previous, STILL])
    found, increment, violation, value, discarded, feasible, evaluations = evolve(
        SOLVER.model, problem, small, seeds, np.random.default_rng(seed)
    )
    assert discarded + feasible <= evaluations
    if not found:
        assert discarded == 12 + 3 * (12 - 0)
        return
    gap = problem.position - tool_pose(SOLVER.model, START + increment)[0]
    assert np.linalg.norm(gap) < problem.position_tolerance
    assert np.all(increment >= problem.lower)
    assert np.all(increment <= problem.upper)
    assert np.all(np.abs(increment) <= SOLVER.limits.reach)
    assert np.all(SOLVER.limits.violation(START + increment) == 0.0)
    assert value == pytest.approx(cost(SOLVER.model, problem, increment), rel=1e-6)
    assert violation >= 0.0


def test_where_nothing_is_on_the_path_nothing_is_found():
    problem = problem_near([0.0, 0.0, 1.0])
    found, _, violation, value, discarded, feasible, _ = evolve(
        SOLVER.model, problem, SETTINGS, np.array([STILL]), np.random.default_rng(0)
    )
    assert not found
    assert (violation, value, feasible) == (np.inf, np.inf, 0)
    assert discarded == SETTINGS.population * SETTINGS.generations
    choice = SOLVER.choose(problem, 0)
    assert not choice.valid
    assert 0.5 < choice.distance < 1.0 - SOLVER.limits.reach[2]


def test_the_best_is_at_least_as_good_as_every_seed():
    problem = problem_near([0.0, 0.0, 0.001])
    seeds = np.array([STILL, 0.5 * problem.upper, 0.5 * problem.lower])
    _, _, violation, value, *_ = evolve(
        SOLVER.model, problem, SETTINGS, seeds, np.random.default_rng(0)
    )
    for seed in seeds:
        _, seed_violation, seed_cost = judge(SOLVER.model, problem, seed.copy())
        assert (violation, value) <= (seed_violation, seed_cost)


def test_generations_without_polish_improve_on_the_first():
    problem = problem_near([0.0, 0.0, 0.001])
    plain = SETTINGS._replace(refinements=0, elite=1, population=40)
    values = []
    for generations in (1, 10, 40):
        settings_ = plain._replace(generations=generations)
        nothing = np.zeros((0, 8))
        result = evolve(SOLVER.model, problem, settings_, nothing, np.random.default_rng(2))
        values.append(result[3])
    assert values[0] > values[1] >= values[2]
    assert values[2] < 0.9 * values[0]


def test_the_polish_lowers_the_cost_within_bounds_and_on_the_path():
    problem = problem_near([0.0, 0.0, 0.001])
    increment = 0.3 * problem.upper
    _, violation, value = judge(SOLVER.model, problem, increment)
    after_violation, after, judged = refine(SOLVER.model, problem, increment, violation, value, 10)
    assert judged >= 1
    assert (after_violation, after) < (violation, value)
    assert np.all(increment >= problem.lower)
    assert np.all(increment <= problem.upper)
    gap = problem.position - tool_pose(SOLVER.model, START + increment)[0]
    assert np.linalg.norm(gap) < 1e-7
    # no feasible direction lowers the cost further
    rng = np.random.default_rng(0)
    for _ in range(50):
        trial = increment + 1e-3 * rng.normal(size=8) * problem.reach
        valid, trial_violation, trial_value = judge(SOLVER.model, problem, trial)
        if valid and trial_violation == 0.0:
            assert trial_value > after - 1e-6


def test_the_same_seed_and_step_give_the_same_choice_and_others_do_not():
    problem, loose = problem_near([0.0, 0.0, 0.001]), SETTINGS._replace(refinements=0)

    def chosen(seed, index):
        rng = generator(seed, f"planner step {index}")
        return evolve(SOLVER.model, problem, loose, np.zeros((0, 8)), rng)[1]

    assert np.array_equal(chosen(1, 7), chosen(1, 7))
    assert not np.array_equal(chosen(1, 7), chosen(2, 7))
    assert not np.array_equal(chosen(1, 7), chosen(1, 8))
    assert np.array_equal(
        SOLVER.choose(problem, 7).increment, solver_of(seed=1).choose(problem, 7).increment
    )
