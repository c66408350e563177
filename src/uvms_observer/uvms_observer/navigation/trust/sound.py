"""Whether a filter's state can be one at all."""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_observer.navigation.state import NavigationState


def is_sound(state: NavigationState) -> bool:
    """Whether the state is finite and its variances are not negative."""
    return _is_sound(state.covariance, state.position, state.velocity)


@exact_kernel
def _is_sound(P: Array, position: Array, velocity: Array) -> bool:
    total = 0.0
    for i in range(P.shape[0]):
        for j in range(P.shape[1]):
            total += P[i, j]
        if P[i, i] < 0.0:
            return False
    for i in range(3):
        total += position[i] + velocity[i]
    return bool(np.isfinite(total))
