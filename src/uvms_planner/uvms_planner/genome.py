"""Binary chromosomes: each variable's increment in `bits` bits, Gray coded.

A gene encodes an increment between its `lower` and `upper` bound of the step, so that every
chromosome lies within the rate and joint limits. Gray code is used because in plain binary
all bits flip in the middle of the range, which means no motion.
"""

import numpy as np

from uvms_dynamics.kernels.jit import kernel


@kernel
def encode(increment, lower, upper, bits, chromosome):
    """Write `increment` (m,) into `chromosome` (m bits,) uint8, rounded to the nearest code."""
    top = (np.int64(1) << bits) - 1
    for i in range(increment.shape[0]):
        width = upper[i] - lower[i]
        share = (increment[i] - lower[i]) / width if width > 0.0 else 0.0
        number = np.int64(round(min(max(share, 0.0), 1.0) * top))
        gray = number ^ (number >> 1)
        for k in range(bits):
            chromosome[i * bits + k] = (gray >> (bits - 1 - k)) & 1


@kernel
def decode(chromosome, lower, upper, bits, increment):
    """Read `chromosome` (m bits,) into `increment` (m,), within `lower` and `upper`."""
    top = (np.int64(1) << bits) - 1
    for i in range(increment.shape[0]):
        number = np.int64(0)
        bit = np.int64(0)
        for k in range(bits):
            bit ^= chromosome[i * bits + k]
            number = (number << 1) | bit
        increment[i] = lower[i] + (upper[i] - lower[i]) * (number / top)
