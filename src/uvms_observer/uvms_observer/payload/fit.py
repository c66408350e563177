"""Weight, place and mass of a payload from the information about its forces (kernels)."""

from typing import Any

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_observer.payload.step_search import likelihood_of_step

ROUNDS = 6
"""Of Gauss and Newton from a rough start; only the products w p and m p are not linear."""
LEAST_WEIGHT_N = 0.1
"""What is known of the mass is stated for a weight of at least this."""
NOTHING_KNOWN = 1e-6
"""Information about the weight from no data, 1/N^2, so that there is always an answer."""


@exact_kernel
def theta_of(phi: Array) -> Array:
    """(w, w p, m, m p) (8,) of phi = (w, p, m) (5,)."""
    theta = np.empty(8)
    theta[0], theta[4] = phi[0], phi[4]
    for k in range(3):
        theta[1 + k], theta[5 + k] = phi[0] * phi[1 + k], phi[4] * phi[1 + k]
    return theta


@exact_kernel
def fit(L: Array, d: Array, phi: Array, known: Array, rounds: int) -> tuple[Array, Array, float]:
    """The most likely phi = (w, p, m) (5,), its covariance (5, 5) and 2 ln(likelihood ratio).

    Least squares of theta(phi) with information L and d = L theta (Gauss and Newton), and with what
    is known of any payload: p = 0 +- grip, and m = (per_weight +- spread) |w|.

    Args:
        L, d: (8, 8) and (8,).
        phi: (5,) where the search begins.
        known: (3,) grip, m, and per_weight and spread, kg/N.
        rounds: of Gauss and Newton.
    """
    grip, per_weight, spread = known[0], known[1], known[2]
    phi, J = phi.copy(), np.zeros((8, 5))
    covariance: Any = np.zeros((5, 5))
    for _ in range(rounds):
        w, m, size = phi[0], phi[4], max(abs(phi[0]), LEAST_WEIGHT_N)
        J[0, 0] = J[4, 4] = 1.0
        for k in range(1, 4):
            J[k, 0], J[k, k], J[4 + k, 4], J[4 + k, k] = phi[k], w, phi[k], m
        transposed = J.T.copy()
        information = transposed @ (L @ J)
        slope = transposed @ (d - L @ theta_of(phi))
        information[0, 0] += NOTHING_KNOWN
        for k in range(1, 4):
            information[k, k] += 1.0 / grip**2
            slope[k] -= phi[k] / grip**2
        weight = 1.0 / (spread * size) ** 2
        information[4, 4] += weight
        slope[4] -= weight * (m - per_weight * size)
        covariance = np.linalg.inv(information)
        phi = phi + covariance @ slope
    return phi, covariance, likelihood_of_step(L, d, theta_of(phi))


@exact_kernel
def most_likely(
    L: Array, d: Array, energy: Array, known: Array, least: float
) -> tuple[int, Array, Array, float]:
    """The candidate with the greatest likelihood ratio, and its fit; -1 where none is likely.

    Args:
        L, d, energy: of the candidates; those whose energy is below `least` cannot be likely.
    """
    best, phi, covariance, greatest = -1, np.zeros(5), np.zeros((5, 5)), least
    for c in range(energy.shape[0]):
        if energy[c] < least:
            continue
        start = np.zeros(5)
        start[0] = d[c, 0] / max(L[c, 0, 0], NOTHING_KNOWN)
        start[4] = known[1] * abs(start[0])
        found, its, ratio = fit(L[c], d[c], start, known, ROUNDS)
        if ratio >= greatest:
            best, phi, covariance, greatest = c, found, its, ratio
    return best, phi, covariance, greatest


@exact_kernel
def without_mass(L: Array) -> Array:
    """Information (8, 8) about (w, w p) alone: what is left when the mass is taken as unknown."""
    kept = np.zeros((8, 8))
    inertia = L[4:, 4:] + NOTHING_KNOWN * np.eye(4)
    across = L[:4, 4:].copy()
    kept[:4, :4] = L[:4, :4] - across @ np.linalg.solve(inertia, across.T.copy())
    return kept
