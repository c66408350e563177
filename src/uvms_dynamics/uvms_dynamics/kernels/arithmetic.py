"""Functions that the kernels use beside + - * /, without branches.

They are made of plain arithmetic and of `primitives`, so that one source serves one number and
eight lanes, and both come out alike. To the last bit or two they agree with the C library, which
they beat: the compiler inlines them and works on several at once.
"""

import math

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.numba_internals.primitives import (
    ROUND,
    copysign,
    fabs,
    maximum,
    minimum,
    power_of_two,
)

# pi in parts of 33 bits, which a whole number below 2^20 multiplies without rounding: not every
# processor rounds a product and the sum behind it once
_PI_HIGH, _PI_MIDDLE, _PI_LOW = 3.1415926534682512, 1.2154201012607932e-10, 4.044532497591901e-21
_LN2_HIGH, _LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
_TANH_IS_ONE = 20.0  # 1 - tanh(20) is 8e-18

# 1 / k! with the signs of the series
_S3, _S5, _S7, _S9, _S11, _S13, _S15, _S17, _S19, _S21 = (
    (-1.0) ** (k // 2) / math.factorial(k) for k in range(3, 22, 2)
)
_C4, _C6, _C8, _C10, _C12, _C14, _C16, _C18, _C20 = (
    (-1.0) ** (k // 2) / math.factorial(k) for k in range(4, 21, 2)
)
_E2, _E3, _E4, _E5, _E6, _E7, _E8, _E9, _E10, _E11, _E12, _E13 = (
    1.0 / math.factorial(k) for k in range(2, 14)
)


@inner
def sine_cosine(x):
    """Sine and cosine of x, in rad: Taylor series after taking off the nearest multiple of pi."""
    k = (x * (1.0 / math.pi) + ROUND) - ROUND
    r = ((x - k * _PI_HIGH) - k * _PI_MIDDLE) - k * _PI_LOW
    odd = k - 2.0 * ((0.5 * k + ROUND) - ROUND)  # -1, 0 or 1
    sign = 1.0 - 2.0 * odd * odd
    z = r * r
    sine = _S13 + z * (_S15 + z * (_S17 + z * (_S19 + z * _S21)))
    sine = _S3 + z * (_S5 + z * (_S7 + z * (_S9 + z * (_S11 + z * sine))))
    cosine = _C12 + z * (_C14 + z * (_C16 + z * (_C18 + z * _C20)))
    cosine = 1.0 + z * (-0.5 + z * (_C4 + z * (_C6 + z * (_C8 + z * (_C10 + z * cosine)))))
    return sign * (r + r * (z * sine)), sign * cosine


@inner
def hyperbolic_tangent(x):
    """Tanh x = -E / (2 + E) with E = exp(-2 |x|) - 1, and the sign of x."""
    y = -2.0 * minimum(fabs(x), _TANH_IS_ONE)
    k = (y * (1.0 / math.log(2.0)) + ROUND) - ROUND
    r = (y - k * _LN2_HIGH) - k * _LN2_LOW
    high = _E8 + r * (_E9 + r * (_E10 + r * (_E11 + r * (_E12 + r * _E13))))
    low = _E2 + r * (_E3 + r * (_E4 + r * (_E5 + r * (_E6 + r * (_E7 + r * high)))))
    scale = power_of_two(k)
    e = (scale - 1.0) + scale * (r + (r * r) * low)
    return copysign(-e / (2.0 + e), x)


@inner
def bounded(x, bound):
    """The number in -bound..bound that is nearest to x."""
    return minimum(maximum(x, -bound), bound)
