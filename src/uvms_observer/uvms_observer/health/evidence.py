"""What a stretch of time says about each thruster: a test of likelihood ratios over one window.

The wrench that motion needs beyond whole thrusters is, tick by tick,

    r(t) = d(t) - b_i (1 - e_i) T_i(t) + noise       from the tick t_0 on, at which i fails,

with the thruster's column b_i, its lagged thrust T_i and what is left of it, e_i. A stuck thruster
gives a constant u_i instead: r = d - b_i (T_i - u_i). d is a constant and what water does that is
not as the model has it, sum of x_j n_j(t) with x_j of known size (`uvms_dynamics.kernels.ambient`):
as a hull turns and gathers speed in a current, d changes in step with the thrust. With noise of
known size, each onset and each thruster is a linear regression beside d. Channels are weighted by
1 / sigma^2; what lies across b_i must stay at the noise: a disturbance along exactly this direction
and in step with this thrust is what no current does (Willsky and Jones 1976, "A generalized
likelihood ratio approach", whose growing bank of onsets is cut to the window here).
"""

import numpy as np

from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.products import inner_product

NONE, WEAK, STUCK = 0, 1, 2
"""What is found: nothing, a share that is left, a thrust that does not follow."""

COLUMNS = 11
GAIN, LEFT, SHARE, SIGMA, ONSET, KIND, THRUST, INFORMATION, TOTAL, BESIDES, FOLLOWED = range(
    COLUMNS
)
"""Columns of the evidence:

GAIN: fall of chi^2 against no fault. LEFT, TOTAL: chi^2 per value with the fault and without any.
SHARE, SIGMA: lost share and its std. ONSET: its tick in the window. KIND: WEAK or STUCK. THRUST:
the stuck thrust, N. INFORMATION: what the whole window tells of the share, 1 / variance. BESIDES:
share of the evidence that is not of the channel with the most. FOLLOWED: by how much chi^2 would be
smaller still if it were the other way round, a disturbance that the thrust follows.
"""


@exact_kernel
def weigh(residual, thrust, water, columns, weights, low, high, step, lags, evidence):
    """Fill `evidence` (m, COLUMNS) from a window.

    Args:
        residual: r (k, 6), oldest first.
        thrust: lagged thrusts (k, m), N.
        water: n (k, 6, p), wrenches that x of mean 0 and variance 1 scales.
        columns: thruster matrix (6, m).
        weights: 1 / sigma^2 (6,).
        low, high: bounds (m,) of the lost shares.
        step: onsets tried are this many ticks apart.
        lags: least and greatest time, in ticks, by which thrust follows a disturbance.
        evidence: (m, COLUMNS), written.
    """
    (k, m), p = thrust.shape, water.shape[2]
    roots = np.sqrt(weights)
    left, basis = np.empty((6, k)), np.empty((p, 6, k))
    total = _without_water(residual, water, roots, left, basis)
    along, ways = np.empty(k), np.empty((p, k))
    for i in range(m):
        scale = most = 0.0
        along[:] = 0.0
        ways[:] = 0.0
        for c in range(6):
            direction = roots[c] * columns[c, i]
            scale, most = scale + direction**2, max(most, direction**2)
            if direction != 0.0:
                _take_off(along, -direction, left[c])
                for j in range(p):
                    _take_off(ways[j], -direction, basis[j, c])
        along /= scale
        ways /= np.sqrt(scale)
        _weigh_one(along, ways, thrust, i, scale, low[i], high[i], step, total, evidence)
        evidence[i, BESIDES] = 1.0 - most / scale
        evidence[i, FOLLOWED] = _followed(along, ways, thrust, i, scale, lags, evidence)


@exact_inner
def _without_water(residual, water, roots, left, basis):
    """Sum of squares that neither a constant nor the water explains, in sigmas.

    `left` (6, k) is written with r less both, and `basis` (p, 6, k) with the water's wrenches made
    orthonormal (Gram-Schmidt) together with one row each of what is known of its size.
    """
    p = water.shape[2]
    known = np.eye(p)
    for c in range(6):
        _centre(residual[:, c], roots[c], left[c])
        for j in range(p):
            _centre(water[:, c, j], roots[c], basis[j, c])
    left, basis = left.reshape(-1), basis.reshape(p, -1)
    for j in range(p):
        for i in range(j):
            same = inner_product(basis[i], basis[j]) + inner_product(known[i], known[j])
            _take_off(basis[j], same, basis[i])
            _take_off(known[j], same, known[i])
        size = np.sqrt(inner_product(basis[j], basis[j]) + inner_product(known[j], known[j]))
        basis[j] /= size
        known[j] /= size
    total = inner_product(left, left)
    for j in range(p):
        same = inner_product(basis[j], left)
        _take_off(left, same, basis[j])
        total -= same * same
    return total


@exact_inner
def _take_off(a, size, b):
    for k in range(a.shape[0]):
        a[k] -= size * b[k]


@exact_inner
def _centre(values, root, out):
    """Write values (k,) less their mean, times root."""
    mean = 0.0
    for t in range(values.shape[0]):
        mean += values[t]
    mean /= values.shape[0]
    for t in range(values.shape[0]):
        out[t] = root * (values[t] - mean)


@exact_inner
def _weigh_one(along, ways, thrust, i, scale, low, high, step, total, evidence):
    """The best onset of thruster i.

    along (k,): r without disturbances in newtons of its thrust. ways (p, k): likewise the basis.
    """
    p, k = ways.shape
    evidence[i, GAIN] = 0.0
    evidence[i, KIND] = NONE
    evidence[i, INFORMATION], evidence[i, TOTAL] = 0.0, total / (6.0 * k)
    count = ft = ff = ty = sy = 0.0  # sums after the onset: T, T^2, T y, y
    by, ones = np.zeros(p), np.zeros(p)  # of the basis times T, and of the basis
    for t in range(k - 1, -1, -1):
        value, y = thrust[t, i], along[t]
        count += 1.0
        ft += value
        ff += value * value
        ty += value * y
        sy += y
        for j in range(p):
            by[j] += value * ways[j, t]
            ones[j] += ways[j, t]
        if t % step or count < 4.0:
            continue
        tt = ff - ft * ft / k  # of the regressor, without what is mean or water of it
        bb, tb = count - count * count / k, ft - ft * count / k
        for j in range(p):
            tt -= by[j] * by[j]
            bb -= ones[j] * ones[j]
            tb -= by[j] * ones[j]
        if tt > 1e-9:
            share = min(max(-ty / tt, low), high)
            gain = -scale * (2.0 * share * ty + share * share * tt)
            _keep(evidence, i, gain, total, k, share, 1.0 / np.sqrt(scale * tt), t, WEAK, 0.0)
            if t == 0:
                evidence[i, INFORMATION] = scale * tt
        if t > 0 and bb > 1e-9:  # a constant from the start cannot be told from a disturbance
            stuck = (sy + high * tb) / bb
            gain = -scale * (high * high * tt + 2.0 * high * ty - bb * stuck * stuck)
            _keep(evidence, i, gain, total, k, high, 1.0 / np.sqrt(scale * bb), t, STUCK, stuck)


@exact_inner
def _followed(along, ways, thrust, i, scale, lags, evidence):
    """Fall of chi^2 along b_i from the best fault to the best r(t - lag) = d - b_i T_i(t).

    A controller answers a disturbance with the opposite thrust, a little later. What looks like
    lost thrust is then ahead of it, whereas a fault is in step with the thrust. The water has what
    it is given beside the fault.
    """
    if evidence[i, KIND] == NONE:
        return 0.0
    k, onset, stuck = along.shape[0], int(evidence[i, ONSET]), evidence[i, THRUST]
    share, best, beside = evidence[i, SHARE], -np.inf, along.copy()
    for j in range(ways.shape[0]):
        size = 0.0
        for t in range(onset, k):
            size += share * (thrust[t, i] - stuck) * ways[j, t]
        for t in range(k):
            beside[t] -= size * ways[j, t]
    for lag in range(lags[0], min(lags[1], k // 2) + 1):
        fault = _spread(beside, thrust, i, 0, lag, share, onset, stuck)
        follows = _spread(beside, thrust, i, lag, lag, 1.0, 0, 0.0)
        best = max(best, scale * (fault - follows))
    return best


@exact_inner
def _spread(along, thrust, i, lag, first, share, onset, stuck):
    """Squared sum about its mean of r(t - lag) + share (T(t) - stuck), from tick `first` on."""
    total = squares = 0.0
    for t in range(first, along.shape[0]):
        value = along[t - lag]
        if t >= onset:
            value += share * (thrust[t, i] - stuck)
        total, squares = total + value, squares + value * value
    return squares - total * total / (along.shape[0] - first)


@exact_inner
def _keep(evidence, i, gain, total, k, share, sigma, onset, kind, stuck):
    """Note the better explanation; that of a stuck thruster has one parameter more to pay for."""
    price = 0.0 if kind == WEAK else np.log(6.0 * k)
    if gain - price <= evidence[i, GAIN]:
        return
    evidence[i, GAIN] = gain - price
    evidence[i, LEFT] = (total - gain) / (6.0 * k)
    evidence[i, SHARE], evidence[i, SIGMA] = share, sigma
    evidence[i, ONSET], evidence[i, KIND] = onset, kind
    evidence[i, THRUST] = stuck
