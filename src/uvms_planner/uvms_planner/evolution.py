"""The genetic algorithm of the paper's Fig. 3: one call finds the best increment of one step.

Binary chromosomes, roulette-wheel selection by eq. (18), crossover, mutation. Added to the paper:
seeds in addition to the random individuals, elitism, projection onto the path (candidates still
not within e are discarded, as in the paper), Deb's rule for the attitude limits, refinement of the
best.
"""

from typing import NamedTuple

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel, shared
from uvms_planner.constraints import better
from uvms_planner.fitness import judge
from uvms_planner.genome import decode, encode
from uvms_planner.linear import copy_into
from uvms_planner.refine import refine


class EvolutionSettings(NamedTuple):
    """The values of GeneticConfig in the form that the kernels take."""

    population: int
    generations: int
    bits: int
    crossover_rate: float
    mutation_rate: float
    elite: int
    seed_refinements: int
    refinements: int


@inner
def selection_fitness(valid, violation, cost, fitness):
    """Fill `fitness` (p,): 1 / cost, eq. (18); 0 for the discarded.

    Individuals that break an attitude limit stay below every one that does not, the further the
    lower (Deb): the lowest fitness without violation times 1 / (2 + violation in degrees).
    """
    lowest = np.inf
    for i in range(cost.shape[0]):
        fitness[i] = 0.0
        if valid[i] and violation[i] == 0.0:
            fitness[i] = 1.0 / max(cost[i], 1e-12)
            lowest = min(lowest, fitness[i])
    if lowest == np.inf:
        lowest = 1.0
    for i in range(cost.shape[0]):
        if valid[i] and violation[i] > 0.0:
            fitness[i] = lowest / (2.0 + np.rad2deg(violation[i]))


@inner
def roulette(fitness, draw):
    """Index chosen with probability proportional to `fitness` (p,) by `draw` in [0, 1)."""
    total = 0.0
    for i in range(fitness.shape[0]):
        total += fitness[i]
    if total <= 0.0:
        return int(draw * fitness.shape[0])
    mark, last = draw * total, 0
    for i in range(fitness.shape[0]):
        if fitness[i] > 0.0:
            last = i
            mark -= fitness[i]
            if mark < 0.0:
                return i
    return last


@inner
def cross_over(first, second, point):
    """Swap the bits of two chromosomes from `point` on, in place."""
    for k in range(point, first.shape[0]):
        first[k], second[k] = second[k], first[k]


@inner
def mutate(chromosome, rate, rng):
    """Flip each bit with probability `rate`, in place."""
    for k in range(chromosome.shape[0]):
        if rng.random() < rate:
            chromosome[k] ^= 1


@inner
def fill_elite(valid, violation, cost, elite):
    """Fill `elite` (e,) with the indices of the best individuals by Deb's rule, best first."""
    taken = np.zeros(cost.shape[0], dtype=np.bool_)
    for place in range(elite.shape[0]):
        best = -1
        for i in range(cost.shape[0]):
            if taken[i] or not valid[i]:
                continue
            if best < 0 or better(violation[i], cost[i], violation[best], cost[best]):
                best = i
        elite[place] = best
        if best >= 0:
            taken[best] = True


@shared
def breed(chromosomes, fitness, settings, rng, children, start):
    """Fill `children` (p, bits) from row `start` on: selection, crossover, mutation."""
    bits = chromosomes.shape[1]
    for i in range(start, children.shape[0]):
        copy_into(children[i], chromosomes[roulette(fitness, rng.random())])
    for i in range(start, children.shape[0] - 1, 2):
        if rng.random() < settings.crossover_rate:
            cross_over(children[i], children[i + 1], 1 + int(rng.random() * (bits - 1)))
    for i in range(start, children.shape[0]):
        mutate(children[i], settings.mutation_rate, rng)


@kernel
def evolve(model, problem, settings, seeds, rng):
    """The best increment (m,) of one step, from `seeds` (s, m) and random individuals.

    Returns (found, increment, violation in rad, cost, discarded, feasible, evaluations); without a
    single individual within e of the path `found` is False.
    """
    size, count = problem.configuration.shape[0], settings.population
    chromosomes = np.zeros((count, size * settings.bits), dtype=np.uint8)
    children = np.zeros_like(chromosomes)
    increments, children_increments = np.zeros((count, size)), np.zeros((count, size))
    valid = np.zeros(count, dtype=np.bool_)
    violation, cost, fitness = np.zeros(count), np.zeros(count), np.zeros(count)
    elite = np.full(settings.elite, -1)
    kept, discarded, feasible, evaluations = 0, 0, 0, 0

    _first_generation(problem, settings, seeds, rng, chromosomes, increments)
    for generation in range(settings.generations):
        for i in range(kept, count):
            valid[i], violation[i], cost[i] = judge(model, problem, increments[i])
            if generation == 0 and i < seeds.shape[0] and valid[i]:
                violation[i], cost[i], judged = refine(
                    model, problem, increments[i], violation[i], cost[i], settings.seed_refinements
                )
                evaluations += judged
            evaluations += 1
            discarded += not valid[i]
            feasible += valid[i] and violation[i] == 0.0
            # the projected individual is what is inherited
            encode(increments[i], problem.lower, problem.upper, settings.bits, chromosomes[i])
        fill_elite(valid, violation, cost, elite)
        if generation == settings.generations - 1:
            break
        selection_fitness(valid, violation, cost, fitness)
        kept = _keep_elite(elite, chromosomes, increments, children, children_increments)
        _move_judgement(elite, kept, valid, violation, cost)
        breed(chromosomes, fitness, settings, rng, children, kept)
        for i in range(kept, count):
            decode(children[i], problem.lower, problem.upper, settings.bits, children_increments[i])
        chromosomes, children = children, chromosomes
        increments, children_increments = children_increments, increments

    best = elite[0]
    if best < 0:
        return False, np.zeros(size), np.inf, np.inf, discarded, feasible, evaluations
    increment = np.empty(size)
    copy_into(increment, increments[best])
    worst, least, judged = refine(
        model, problem, increment, violation[best], cost[best], settings.refinements
    )
    return True, increment, worst, least, discarded, feasible, evaluations + judged


@inner
def _first_generation(problem, settings, seeds, rng, chromosomes, increments):
    """Fill `increments` (p, m) with the seeds and then with what random bits mean."""
    for i in range(increments.shape[0]):
        if i < seeds.shape[0]:
            copy_into(increments[i], seeds[i])
            continue
        for k in range(chromosomes.shape[1]):
            chromosomes[i, k] = rng.random() < 0.5
        decode(chromosomes[i], problem.lower, problem.upper, settings.bits, increments[i])


@inner
def _keep_elite(elite, chromosomes, increments, children, children_increments):
    kept = 0
    for place in range(elite.shape[0]):
        if elite[place] >= 0:
            copy_into(children[kept], chromosomes[elite[place]])
            copy_into(children_increments[kept], increments[elite[place]])
            kept += 1
    return kept


@inner
def _move_judgement(elite, kept, valid, violation, cost):
    """Put the judgement of the elite where the elite now stands."""
    violations, costs = np.zeros(kept), np.zeros(kept)
    for place in range(kept):
        violations[place], costs[place] = violation[elite[place]], cost[elite[place]]
    for place in range(kept):
        valid[place], violation[place], cost[place] = True, violations[place], costs[place]
