"""The S-surface law, eq. (19) and (23), and a Lyapunov function of its loop, eq. (27).

The paper's names are unusual: its K_d multiplies the error and its K_p the rate of the error.
Here they are `k_error` and `k_rate`.
"""

from dataclasses import dataclass
from functools import cached_property
from math import factorial

import numpy as np

from uvms_control.errors import ControlSetupError
from uvms_core.signals import Array


@dataclass(frozen=True)
class SSurface:
    """Gains of the law, one value per axis; every array (k,), all positive.

    With normalised errors x = e / error_scale and x' = e_dot / rate_scale the law gives the
    acceleration A * S(k_error x + k_rate x'), where S(s) = 2 / (1 + exp(-s)) - 1 = tanh(s / 2).
    """

    k_error: Array  # no unit; the paper's K_d
    k_rate: Array  # no unit; the paper's K_p
    error_scale: Array  # m or rad
    rate_scale: Array  # m/s or rad/s
    amplitude: Array  # m/s^2 or rad/s^2

    def __post_init__(self) -> None:
        size = np.size(self.k_error)
        for name in ("k_error", "k_rate", "error_scale", "rate_scale", "amplitude"):
            value = np.array(getattr(self, name), dtype=np.float64)
            if value.shape != (size,) or not (np.isfinite(value) & (value > 0.0)).all():
                raise ControlSetupError(
                    f"S-surface {name}: {value}, expected {size} positive finite numbers"
                )
            object.__setattr__(self, name, value)

    def argument(self, error: Array, rate: Array) -> Array:
        """What S is applied to, s = k_error e / error_scale + k_rate e_dot / rate_scale."""
        return self.k_error * error / self.error_scale + self.k_rate * rate / self.rate_scale

    def control(self, error: Array, rate: Array) -> Array:
        """Eq. (19) without Delta-u, in the form of eq. (23): u = S(s) (k,), between -1 and 1."""
        return sigmoid(self.argument(error, rate))

    def acceleration(self, error: Array, rate: Array, delta_u: Array | float = 0.0) -> Array:
        """A (u + Delta-u) (k,), m/s^2 or rad/s^2."""
        return self.acceleration_of(self.argument(error, rate), delta_u)

    def acceleration_of(self, argument: Array, delta_u: Array | float = 0.0) -> Array:
        """The same from what S is applied to."""
        return self.amplitude * (sigmoid(argument) + delta_u)

    @cached_property
    def stiffness(self) -> Array:
        """Slope against the error near zero (k,), 1/s^2: A k_error / (2 error_scale), eq. (26)."""
        return self.amplitude * self.k_error / (2.0 * self.error_scale)

    @cached_property
    def damping(self) -> Array:
        """Slope against the rate near zero (k,), 1/s: A k_rate / (2 rate_scale), eq. (26).

        Corrected from the print: the linear part of tanh(s / 2) is s / 2, and the stiffness comes
        from the gain on the error.
        """
        return self.amplitude * self.k_rate / (2.0 * self.rate_scale)


def sigmoid(s: Array) -> Array:
    """S(s) = 2 / (1 + exp(-s)) - 1 = tanh(s / 2), eq. (19) and (23), safe for any size of s."""
    return np.tanh(0.5 * np.asarray(s, dtype=np.float64))


def sigmoid_series(s: Array, terms: int) -> Array:
    """The first `terms` terms of S(s) = s/2 - s^3/24 + s^5/240 - ..., for |s| < pi.

    sum over n of 2^(2n) (2^(2n) - 1) B_2n (s/2)^(2n-1) / (2n)!, eq. (23), signs corrected from
    the print.
    """
    from scipy.special import bernoulli  # no controller needs it

    numbers = bernoulli(2 * terms)
    half = 0.5 * np.asarray(s, dtype=np.float64)
    total = np.zeros_like(half)
    for n in range(1, terms + 1):
        coefficient = 4.0**n * (4.0**n - 1.0) * numbers[2 * n] / factorial(2 * n)
        total += coefficient * half ** (2 * n - 1)
    return total


def lyapunov(
    error: Array, rate: Array, stiffness: Array, damping: Array, epsilon: float | None = None
) -> Array:
    """Lyapunov function of the error loop along a run, shape (...) for errors (..., k).

        V = 1/2 e^T [P + eps D - eps^2 I] e + 1/2 |e_dot + eps e|^2,   0 < eps < min(D)

    for the linear part e_ddot = -P e - D e_dot of eq. (26), with `SSurface.stiffness` P and
    `SSurface.damping` D (k,). There V_dot = -eps e^T P e - e_dot^T (D - eps I) e_dot. `epsilon`
    defaults to half its bound. Eq. (27) corrected from the print: the paper swaps P and D between
    (19) and (26), and adds 1/2 e_dot^T M e_dot, which (29) does not need and which makes V grow on
    parts of the linear loop when M is large.
    """
    stiffness, damping = np.asarray(stiffness), np.asarray(damping)
    bound = float(np.min(damping))
    eps = 0.5 * bound if epsilon is None else epsilon
    if not 0.0 < eps < bound:
        raise ControlSetupError(f"lyapunov epsilon: {eps}, expected between 0 and {bound:.6g}")
    weight = stiffness + eps * damping - eps**2
    mixed = np.asarray(rate) + eps * np.asarray(error)
    return 0.5 * np.sum(weight * np.square(error), axis=-1) + 0.5 * np.sum(mixed**2, axis=-1)
