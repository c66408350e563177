"""The genetic algorithm as printed: its operators against closed forms, its result, eq. (17)."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planner_rig import (
    CALM,
    START,
    drive,
    reference_vehicle,
    short_figure_9,
    solver_of,
    target_near,
)
from scipy.stats import chisquare, geom

from uvms_core.errors import ConfigError
from uvms_core.plugin import create
from uvms_dynamics import coupling_wrench, restoring_wrench
from uvms_planner import PlannerConfig
from uvms_planner.constraints import attitude_violation
from uvms_planner.methods.paper import printed_settings
from uvms_planner.paper_evolution import decode_plain, gene_lengths, mutate_by_gaps, reproduce
from uvms_planner.projection import tool_pose

SOLVER = solver_of(method="paper", limits=CALM)
CONFIG = PlannerConfig().paper
SETTINGS = printed_settings(SOLVER.model, SOLVER.joints, CONFIG)
STILL = np.zeros(8)
UNLIKELY = 1e-5  # level of significance of the statistical tests, whose seeds are fixed


def problem_near(offset, previous=STILL, solver=SOLVER):
    return solver.problem(START, previous, target_near(solver, START, offset))


def test_six_genes_share_a_thousand_bits():
    assert list(SETTINGS.lengths) == [167, 167, 167, 167, 166, 166]
    assert sum(SETTINGS.lengths) == 1000
    assert list(SETTINGS.variables) == [0, 1, 2, 3, 4, 7]  # not shoulder and elbow


@given(seed=st.integers(0, 2**32 - 1), bits=st.integers(64, 1200), genes=st.integers(1, 9))
@settings(max_examples=60, deadline=None)
def test_a_chromosome_is_decoded_exactly_and_within_the_bounds(seed, bits, genes):
    """Against rational arithmetic, to the rounding of a few doubles."""
    rng = np.random.default_rng(seed)
    lengths, lower = gene_lengths(bits, genes), rng.normal(size=genes)
    upper = lower + rng.random(genes)
    chromosome = rng.integers(0, 2, bits).astype(np.uint8)
    values = np.zeros(genes)
    decode_plain(chromosome, lengths, np.arange(genes), lower, upper, values)
    ends = np.cumsum(lengths)
    for gene in range(genes):
        word = "".join(map(str, chromosome[ends[gene] - lengths[gene] : ends[gene]]))
        share = Fraction(int(word, 2), 2 ** int(lengths[gene]) - 1)
        low, high = Fraction(lower[gene]), Fraction(upper[gene])
        exact = low + (high - low) * share
        scale = max(abs(lower[gene]), abs(upper[gene]))
        assert abs(Fraction(values[gene]) - exact) <= 4 * Fraction(np.spacing(scale))
        assert lower[gene] <= values[gene] <= upper[gene]


def test_the_ends_of_a_gene_are_its_bounds():
    lower, upper, values = np.array([-0.1, 0.3]), np.array([0.7, 0.9]), np.zeros(2)
    lengths, both = gene_lengths(1000, 2), np.arange(2)
    for bit, expected in ((0, lower), (1, upper)):
        decode_plain(np.full(1000, bit, dtype=np.uint8), lengths, both, lower, upper, values)
        assert np.array_equal(values, expected)


def test_parents_have_children_in_proportion_to_their_fitness():
    """Chi-squared test of the wheel as `reproduce` turns it; nobody else has any."""
    count, fitness = 200, np.zeros(200)
    fitness[:5] = [1.0, 2.0, 3.0, 4.0, 10.0]
    parents = np.zeros((count, 64), dtype=np.uint8)
    parents[:, :8] = np.unpackbits(np.arange(count, dtype=np.uint8)[:, None], axis=1)
    children, rng, born = np.zeros_like(parents), np.random.default_rng(2), np.zeros(256)
    for _ in range(50):
        reproduce(parents, fitness, 0.0, 0.0, rng, children)
        born += np.bincount(np.packbits(children[:, :8], axis=1)[:, 0], minlength=256)
    assert np.sum(born[5:]) == 0
    assert chisquare(born[:5], 50 * count * fitness[:5] / 20.0).pvalue > UNLIKELY


@pytest.mark.parametrize("rate", [0.001, 0.02, 0.5])
def test_every_bit_flips_with_the_same_probability_and_on_its_own(rate):
    rng, bits, rounds = np.random.default_rng(6), 1000, 2000
    flips, gaps = np.zeros(bits), []
    for _ in range(rounds):
        chromosome = np.zeros(bits, dtype=np.uint8)
        mutate_by_gaps(chromosome, rate, rng)
        places = np.flatnonzero(chromosome)
        flips += chromosome
        gaps += list(np.diff(places)) if len(places) else []
    expected = rate * bits * rounds
    assert abs(np.sum(flips) - expected) < 4.5 * np.sqrt(expected * (1 - rate))
    assert chisquare(flips.reshape(20, -1).sum(axis=1)).pvalue > UNLIKELY
    if rate > 0.001:  # the gaps of a short chromosome are cut off at its end
        seen = np.bincount(gaps, minlength=7)[1:7]
        shares = geom.pmf(np.arange(1, 7), rate)
        assert chisquare(seen, np.sum(seen) * shares / np.sum(shares)).pvalue > UNLIKELY


@pytest.mark.parametrize(("rate", "bit"), [(0.0, 0), (1.0, 1)])
def test_no_bit_or_every_bit_flips_at_the_ends_of_the_rate(rate, bit):
    chromosome = np.zeros(100, dtype=np.uint8)
    mutate_by_gaps(chromosome, rate, np.random.default_rng(0))
    assert np.all(chromosome == bit)


def test_pairs_cross_over_at_their_rate_at_every_point_alike():
    count, bits, rate = 200, 101, 0.6
    parents = np.zeros((count, bits), dtype=np.uint8)
    parents[1::2] = 1
    rng, points, crossed, mixed = np.random.default_rng(3), np.zeros(bits), 0, 0
    children = np.zeros_like(parents)
    for _ in range(200):
        reproduce(parents, np.ones(count), rate, 0.0, rng, children)
        for first, second in zip(children[::2], children[1::2], strict=True):
            differ = first[0] != second[0]
            mixed += differ  # a pair of unlike parents, in which a crossing can be seen
            jumps = np.flatnonzero(np.diff(first))
            crossed += len(jumps)
            points[jumps + 1] += 1
    assert abs(mixed - 10000) < 4.5 * np.sqrt(5000)
    assert abs(crossed - rate * mixed) < 4.5 * np.sqrt(rate * (1 - rate) * mixed)
    assert points[0] == 0
    assert chisquare(points[1:].reshape(20, -1).sum(axis=1)).pvalue > UNLIKELY


def test_the_best_has_no_privilege():
    """No elite: where every bit flips, no parent is left, however fit."""
    rng = np.random.default_rng(1)
    parents = rng.integers(0, 2, (20, 64)).astype(np.uint8)
    fitness, children = np.ones(20), np.zeros((20, 64), dtype=np.uint8)
    fitness[3] = 1e9
    reproduce(parents, fitness, 0.0, 1.0, rng, children)
    assert np.array_equal(children, np.tile(1 - parents[3], (20, 1)))


@given(
    seed=st.integers(0, 1000),
    offset=st.lists(st.floats(-0.004, 0.004), min_size=3, max_size=3),
    drift=st.lists(st.floats(-0.2, 0.2), min_size=8, max_size=8),
)
@settings(max_examples=30, deadline=None)
def test_whoever_is_chosen_keeps_every_constraint_of_eq_17(seed, offset, drift):
    solver = solver_of(seed=seed, method="paper", paper={"population": 20, "generations": 5})
    problem = problem_near(offset, np.array(drift) * SOLVER.limits.reach, solver)
    choice = solver.choose(problem, 0)
    assert choice.feasible + choice.discarded == choice.evaluations
    if not choice.valid:
        return
    end = START + choice.increment
    gap = problem.position - tool_pose(solver.model, end)[0]
    assert np.linalg.norm(gap) == pytest.approx(choice.distance)
    assert choice.distance < problem.position_tolerance
    assert np.all(choice.increment >= problem.lower)
    assert np.all(choice.increment <= problem.upper)
    assert attitude_violation(solver.model, problem, end[4:].copy()) == 0.0


def test_its_cost_is_eq_18_and_nothing_else():
    problem = problem_near([0.0, 0.0, 0.001])
    choice = SOLVER.choose(problem, 3)
    d, h = choice.increment, problem.step
    yaw = d[3]
    level = np.array([0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)])
    turn = np.array([[np.cos(yaw), np.sin(yaw), 0], [-np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    nu = np.concatenate([turn @ d[:3] / h, [0, 0, d[3] / h]])
    across = np.cross(nu[3:], nu[:3])
    nu_dot = np.concatenate([turn @ d[:3] / h**2 - across, [0, 0, d[3] / h**2]])
    q = START[4:] + d[4:]
    total = restoring_wrench(SOLVER.model, level, q)
    total = total + coupling_wrench(SOLVER.model, nu, nu_dot, q, d[4:] / h, d[4:] / h**2)
    assert choice.cost == pytest.approx(np.sum(total**2), rel=1e-9)


def test_more_generations_do_not_make_it_worse():
    problem, costs = problem_near([0.0, 0.0, 0.001]), []
    for generations in (1, 5, 40):
        solver = solver_of(method="paper", paper={"generations": generations})
        costs.append(solver.choose(problem, 0).cost)
    assert costs[0] >= costs[1] >= costs[2]
    assert costs[2] < costs[0]


def test_the_same_seed_and_step_give_the_same_choice_and_others_do_not():
    problem = problem_near([0.0, 0.0, 0.001])
    few = {"generations": 5, "population": 20}

    def chosen(seed, index):
        solver = solver_of(seed=seed, method="paper", paper=few)
        return solver.choose(problem, index).increment

    assert np.array_equal(chosen(1, 7), chosen(1, 7))
    assert not np.array_equal(chosen(1, 7), chosen(2, 7))
    assert not np.array_equal(chosen(1, 7), chosen(1, 8))


def test_where_everybody_is_discarded_it_says_how_near_the_nearest_came():
    choice = SOLVER.choose(problem_near([0.0, 0.05, 0.0]), 0)
    assert not choice.valid
    assert (choice.feasible, choice.cost) == (0, np.inf)
    assert choice.discarded == choice.evaluations == CONFIG.population * CONFIG.generations
    assert choice.distance > problem_near([0.0, 0.0, 0.0]).position_tolerance


def test_it_takes_no_other_fitness():
    for section in ({"fitness": {"lookahead_s": 1.0}}, {"genetic": {"elite": 1}}):
        config = PlannerConfig.model_validate({"method": "paper", **section})
        with pytest.raises(ConfigError, match="ignores"):
            create(config, reference_vehicle(), 1)


def test_a_path_is_followed_within_e():
    few = {"population": 40, "generations": 10}
    run = drive(method="paper", paper=few, limits={**CALM, "strict": False})
    run.planner.accept(short_figure_9(10.0, 0.1).goal(*run.planner.end_effector))
    result = run.until_finished()
    assert result.success
    assert result.max_planned_error < 2e-3  # e at the knots, and what lies between them
