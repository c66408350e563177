"""When did what is unexplained change, and does a payload explain the change? (kernels)

What the model leaves unexplained of the forces on vehicle and joints, y (6+n,), is taken as

    y = b + S theta 1(t > t0) + noise,

with b a random walk of each row (water, friction, errors of the model), and S theta the forces of a
payload that was grasped at t0, theta = (w, w p, m, m p). A filter that knows of no payload,
b += K (y - b), has the innovations gamma. A step theta at t0 adds G theta to them with G = S - B,
where B is what the filter itself has followed of S since t0: B += K G. So theta, its information
and the likelihood ratio against no payload follow for each candidate t0 recursively (Willsky and
Jones 1976):

    Lambda += G^T W G,  d += G^T W gamma,  2 ln(ratio) = 2 d^T theta - theta^T Lambda theta,

with W the inverse variances of the innovations. Those are not known beforehand, as they depend on
water and model errors: each row's is followed by its squares, and with it the gain, K = 1 - R / s
for noise R and innovation variance s. So a row that waves or a gust shake counts for little, and
one that was quiet before, such as a joint's torque, for much.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel

CANDIDATES = 12
"""Times of grasp that are kept in mind, one for each block: 3 s."""
FORGET = 0.05
"""Share of a block in the innovation variances: 20 blocks, 5 s."""
CLIP = 9.0
"""An innovation counts as at most three standard deviations in its own variance, so that the step
that is looked for does not hide itself."""
SLOWEST = 0.02
"""Least gain of b: 50 blocks, 12 s; slower changes are not told from a payload anyhow."""


@exact_kernel
def follow_block(
    y: Array, S: Array, noise: Array, b: Array, s: Array, theta: Array,
    offset: Array, B: Array, L: Array, d: Array, energy: Array, felt: Array, newest: int,
) -> None:  # fmt: skip
    """Take in the mean of a block, in place.

    The block in which a grasp happens has an unknown share of the step and the impulse of a load
    that is suddenly moved. A candidate leaves it out: `offset` is what b followed of it.

    Args:
        y, S: (m,) and (m, 8) means over the block.
        noise: (m,) variances of y, R.
        b, s: (m,) state of the filter without payload and variances of its innovations.
        theta: (8,) payload that is taken as held; zero for none.
        offset, B, L, d, energy: (c, m), (c, m, 8), (c, 8, 8), (c, 8), (c,) of the candidates, the
            last one of which is the payload held.
        felt: (c,) share of the energy that is in the joints' rows.
        newest: the candidate whose grasp is in this block.
    """
    rows, columns = S.shape
    count = B.shape[0]
    own = count - 1
    B[newest], L[newest], d[newest], offset[newest], energy[newest] = 0.0, 0.0, 0.0, 0.0, 0.0
    felt[newest] = 0.0
    G = np.empty(columns)
    for i in range(rows):
        variance = max(s[i], noise[i] * (1.0 + SLOWEST))
        gain, weight = 1.0 - noise[i] / variance, 1.0 / variance
        raw = y[i] - b[i]
        left = raw + offset[own, i]  # of it, with the payload that is held
        for k in range(columns):
            left -= (S[i, k] - B[own, i, k]) * theta[k]
        for c in range(count):
            gamma, trust = left + offset[c, i], weight
            if c == own:  # what is known of it is not given up for a change that comes
                gamma, trust = (
                    raw + offset[own, i],
                    weight * min(1.0, CLIP * variance / (left * left + 1e-300)),
                )
            if c == newest:
                offset[c, i] = gain * gamma
                continue
            for k in range(columns):
                G[k] = S[i, k] - B[c, i, k]
            for k in range(columns):
                d[c, k] += G[k] * trust * gamma
                for j in range(columns):
                    L[c, k, j] += G[k] * trust * G[j]
                B[c, i, k] += gain * G[k]
            energy[c] += weight * gamma * gamma
            if i >= 6:
                felt[c] += weight * gamma * gamma
            offset[c, i] *= 1.0 - gain
        b[i] += gain * raw
        s[i] = variance + FORGET * (min(left * left, CLIP * variance) - variance)


@exact_kernel
def likelihood_of_step(L: Array, d: Array, theta: Array) -> float:
    """2 ln(ratio) of a step theta (8,) against none."""
    return 2.0 * d.dot(theta) - theta.dot(L @ theta)
