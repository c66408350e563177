"""The genetic algorithm of the paper's Fig. 3 as it is printed: one call finds one step.

A binary chromosome of 1000 bits; two joints from inverse kinematics; whoever is not within e of the
path or breaks a limit of eq. (17) is discarded; fitness eq. (18) alone; roulette-wheel selection,
crossover, mutation. No elite, no seeds, no projection, no polish. `evolution` is the search that
this project plans with.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import inner, kernel, shared
from uvms_planner.constraints import attitude_violation
from uvms_planner.evolution import cross_over, roulette
from uvms_planner.fitness import cost
from uvms_planner.linear import copy_into
from uvms_planner.planar_inverse import solve_planar
from uvms_planner.problem import VEHICLE, StepProblem
from uvms_planner.projection import tool_error, within_tolerance


class PrintedSettings(NamedTuple):
    """The values of PaperConfig and the arm's structure in the form that the kernels take."""

    population: int
    generations: int
    patience: int
    crossover_rate: float
    mutation_rate: float
    first: int  # joints that inverse kinematics solves, from 0
    second: int
    variables: Array  # (g,) int64, which variable of c each gene is
    lengths: Array  # (g,) int64, bits of each gene


def as_printed(problem: StepProblem) -> StepProblem:
    """The problem with eq. (18) as its cost: |F_dis|^2 at the end of the step and nothing else."""
    return problem._replace(
        combined=True,
        lookahead=0.0,
        smoothness_weight=0.0,
        motion_weights=np.zeros_like(problem.motion_weights),
    )


def gene_lengths(bits: int, genes: int) -> Array:
    """Bits (g,) of each gene, as even as `bits` in all allow; the first ones have one more."""
    return np.array([len(part) for part in np.array_split(np.arange(bits), genes)])


@kernel
def decode_plain(chromosome, lengths, variables, lower, upper, increment):
    """Read the genes of `chromosome` into `increment` (m,): plain binary, the highest bit first.

    A gene of k bits with the number b stands for lower + (upper - lower) b / (2^k - 1). The sum is
    taken from the lowest bit on, so that it is rounded as b / 2^k is, whatever the length.
    """
    start = 0
    for gene in range(lengths.shape[0]):
        share = 0.0
        for k in range(start + lengths[gene] - 1, start - 1, -1):
            share = 0.5 * (share + chromosome[k])
        share /= 1.0 - 0.5 ** lengths[gene]
        i = variables[gene]
        value = lower[i] + (upper[i] - lower[i]) * min(share, 1.0)
        increment[i] = min(value, upper[i])
        start += lengths[gene]


@kernel
def mutate_by_gaps(chromosome, rate, rng):
    """Flip each bit with probability `rate`, in place.

    The gaps between flips are geometrically distributed: one random number a flip, not a bit
    (Devroye 1986, sec. X.2).
    """
    if rate <= 0.0:
        return
    if rate >= 1.0:
        for k in range(chromosome.shape[0]):
            chromosome[k] ^= 1
        return
    scale, place = 1.0 / np.log1p(-rate), -1.0
    while True:
        place += 1.0 + np.floor(np.log1p(-rng.random()) * scale)
        if place >= chromosome.shape[0]:
            return
        chromosome[int(place)] ^= 1


@kernel
def complete(model, problem, settings, increment, end):
    """Solve two joints of `increment` (m,) from the others in place; False where they cannot.

    Of the two postures the one within the bounds is taken, of two the smaller motion. `end` (m,)
    becomes the configuration at the end of the step.
    """
    a, b = VEHICLE + settings.first, VEHICLE + settings.second
    best = np.inf
    about_first, about_second = 0.0, 0.0
    for branch in (1.0, -1.0):
        for i in range(increment.shape[0]):
            end[i] = problem.configuration[i] + increment[i]
        end[a], end[b] = problem.configuration[a], problem.configuration[b]
        found, turns = solve_planar(
            model, end, settings.first, settings.second, problem.position, branch
        )
        if not found:
            break
        within = problem.lower[a] <= turns[0] <= problem.upper[a]
        within = within and problem.lower[b] <= turns[1] <= problem.upper[b]
        motion = abs(turns[0]) + abs(turns[1])
        if within and motion < best:
            best, about_first, about_second = motion, turns[0], turns[1]
    increment[a], increment[b] = about_first, about_second
    for i in range(increment.shape[0]):
        end[i] = problem.configuration[i] + increment[i]
    return best < np.inf


@kernel
def assess(model, problem, settings, increment, end, error):
    """(fitness, distance, angle, violation) of an individual; fitness 0 where it is discarded.

    Discarded are those whose two joints have no solution within their bounds, which are not within
    e, or whose free attitude is beyond its limits: the constraints of eq. (17).
    """
    if not complete(model, problem, settings, increment, end):
        return 0.0, np.inf, np.inf, np.inf
    distance, angle = tool_error(
        model, end, problem.position, problem.rotation, problem.oriented, error
    )
    if not within_tolerance(problem, distance, angle):
        return 0.0, distance, angle, np.inf
    violation = attitude_violation(model, problem, end[VEHICLE:])
    if violation > 0.0:
        return 0.0, distance, angle, violation
    return 1.0 / max(cost(model, problem, increment), 1e-12), distance, angle, 0.0


@kernel
def evolve_as_printed(model, problem, settings, rng):
    """The best of all individuals of one step, Fig. 3.

    Returns (fitness, increment (m,), distance, angle, violation, evaluations, feasible). A fitness
    of 0 means that all were discarded: then it is the one that was nearest to the path.
    Where a generation has nobody left, the next one is drawn at random again.
    """
    size, count, bits = problem.configuration.shape[0], settings.population, 0
    for gene in range(settings.lengths.shape[0]):
        bits += settings.lengths[gene]
    parents = np.zeros((count, bits), dtype=np.uint8)
    children = np.zeros_like(parents)
    fitness = np.zeros(count)
    increment, end, error = np.zeros(size), np.zeros(size), np.zeros(6)
    best, best_fitness, idle, feasible, evaluations = np.zeros(size), 0.0, 0, 0, 0
    nearest, angle_of, violation_of = np.inf, np.inf, np.inf
    draw_population(parents, rng)
    for _ in range(settings.generations):
        improved, alive = False, 0
        for i in range(count):
            decode_plain(
                parents[i],
                settings.lengths,
                settings.variables,
                problem.lower,
                problem.upper,
                increment,
            )
            fitness[i], distance, angle, violation = assess(
                model, problem, settings, increment, end, error
            )
            evaluations += 1
            alive += fitness[i] > 0.0
            if fitness[i] > best_fitness or (best_fitness == 0.0 and distance < nearest):
                improved = improved or fitness[i] > 0.0
                best_fitness, nearest = fitness[i], distance
                angle_of, violation_of = angle, violation
                copy_into(best, increment)
        feasible += alive
        idle = 0 if improved or best_fitness == 0.0 else idle + 1
        if idle >= settings.patience:
            break
        if alive == 0:
            draw_population(parents, rng)
            continue
        reproduce(parents, fitness, settings.crossover_rate, settings.mutation_rate, rng, children)
        parents, children = children, parents
    return best_fitness, best, nearest, angle_of, violation_of, evaluations, feasible


@inner
def draw_population(chromosomes, rng):
    """Fill `chromosomes` (p, bits) with fair random bits."""
    for i in range(chromosomes.shape[0]):
        for k in range(chromosomes.shape[1]):
            chromosomes[i, k] = rng.random() < 0.5


@shared
def reproduce(parents, fitness, crossover_rate, mutation_rate, rng, children):
    """Fill `children` (p, bits): roulette, one-point crossover of pairs, mutation."""
    count, bits = children.shape
    for i in range(count):
        copy_into(children[i], parents[roulette(fitness, rng.random())])
    for i in range(0, count - 1, 2):
        if rng.random() < crossover_rate:
            cross_over(children[i], children[i + 1], 1 + int(rng.random() * (bits - 1)))
    for i in range(count):
        mutate_by_gaps(children[i], mutation_rate, rng)
