"""Search for the basin of the best plan: a genetic algorithm over a few postures.

A plan near its optimum is found by Newton steps in no time; what they cannot do is to go over a
ridge. The genes are postures at a few instants of the path; between them the posture goes evenly.
The fitness is the cost of the plan with its penalties, on the coarse pieces.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.rng import generator
from uvms_core.signals import Array
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path import assembly
from uvms_planner.whole_path.discrete import Discrete
from uvms_planner.whole_path.spline import greville

LEAVE_S = 10.0
"""The first posture is taken up by then: the one at the start may be left for good at once."""


@dataclass(frozen=True)
class SearchConfig:
    """Size of the search and how it goes."""

    population: int = 32
    generations: int = 12
    postures: int = 3  # of an individual
    elite: int = 4
    mutation: float = 0.15  # of the range, standard deviation
    kept: float = 0.7  # probability that a gene does not mutate
    yaw: float = np.deg2rad(60.0)  # rad, standard deviation of yaw from that of the start
    barrier: float = 1e-2
    price: float = 1e2  # of a broken limit


def postures_of(discrete: Discrete, genes: Array) -> Array:
    """Coefficients (K, d) of the posture that goes evenly through `genes` (g, d)."""
    duration, start = discrete.problem.duration, discrete.problem.start.value
    times = np.linspace(0.0, duration, len(genes) + 1)
    if len(genes) > 1:
        times[1] = min(LEAVE_S, times[1])
    points = np.vstack([start, genes])
    sites = greville(discrete.knots)
    return discrete.complete(np.stack([np.interp(sites, times, p) for p in points.T], axis=1))


def search(discrete: Discrete, seed: int, config: SearchConfig | None = None) -> Array:
    """Coefficients (K, d) of the fittest individual; the same for the same seed."""
    config = config or SearchConfig()
    rng = generator(seed, "whole path")
    lower, upper = _ranges(discrete, config)
    genes = first_generation(discrete, rng, config)
    costs = np.array([_cost(discrete, each, config) for each in genes])
    for _ in range(config.generations):
        children = [_child(genes, costs, rng, config) for _ in range(len(genes) - config.elite)]
        children = [np.clip(each, lower, upper) for each in children]
        best = np.argsort(costs, kind="stable")[: config.elite]
        genes = np.array([*genes[best], *children])
        new = [_cost(discrete, each, config) for each in children]
        costs = np.array([*costs[best], *new])
    return postures_of(discrete, genes[int(np.argmin(costs))])


def _ranges(discrete: Discrete, config: SearchConfig) -> tuple[Array, Array]:
    """Least and greatest genes (d,); yaw, which has no bounds, within three deviations."""
    limits, start = discrete.problem.limits, discrete.problem.start.value
    lower, upper = limits.lower[VEHICLE - 1 :].copy(), limits.upper[VEHICLE - 1 :].copy()
    lower[0], upper[0] = start[0] - 3 * config.yaw, start[0] + 3 * config.yaw
    return lower, upper


def first_generation(discrete: Discrete, rng, config: SearchConfig) -> Array:
    """Half take up a posture for good, half go on from one to the next."""
    lower, upper = _ranges(discrete, config)
    start, size = discrete.problem.start.value, len(lower)
    genes = rng.uniform(lower, upper, (config.population, config.postures, size))
    genes[:, :, 0] = start[0] + config.yaw * rng.standard_normal(genes.shape[:2])
    share = rng.uniform(0, 1, (config.population, 1, 1))  # near the start as well
    genes = start + share * (genes - start)
    half = config.population // 2
    genes[:half] = genes[:half, :1]
    return genes


def _cost(discrete: Discrete, genes: Array, config: SearchConfig) -> float:
    return float(
        assembly.cost(
            *discrete.arguments(), config.barrier, config.price, postures_of(discrete, genes)
        )
    )


def _child(genes: Array, costs: Array, rng, config: SearchConfig) -> Array:
    """A blend of two parents that won a tournament each, mutated."""
    one, other = (_winner(genes, costs, rng) for _ in range(2))
    share = rng.uniform(-0.25, 1.25, one.shape)
    child = one + share * (other - one)
    spread = config.mutation * np.ptp(genes, axis=(0, 1)) * rng.standard_normal(child.shape)
    return child + np.where(rng.uniform(size=child.shape) < config.kept, 0.0, spread)


def _winner(genes: Array, costs: Array, rng) -> Array:
    first, second = rng.integers(len(genes), size=2)
    return genes[first if costs[first] <= costs[second] else second]
