"""What an arm is like over the whole range of its joints."""

from functools import lru_cache

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model, restoring_wrench
from uvms_dynamics.kernels.jit import kernel
from uvms_planner.problem import yaw_quaternion

POSTURES_LOG2 = 8  # whose restoring wrenches are taken
REMEMBERED = 8  # models and ranges


def spread_postures(lower: Array, upper: Array, log2: int) -> Array:
    """2^log2 postures (k, n) evenly spread between the bounds (n,), always the same ones."""
    from scipy.stats import qmc  # loads in half a second, which a planner at its start can spare

    return lower + qmc.Sobol(len(lower), scramble=False).random_base2(log2) * (upper - lower)


def typical_restoring(model: Model, lower: Array, upper: Array) -> float:
    """Mean of |restoring wrench|^2 over the postures between the bounds (n,), N^2 and N^2 m^2."""
    return _typical(model.tobytes(), model.shape, *(np.array(b).tobytes() for b in (lower, upper)))


@lru_cache(maxsize=REMEMBERED)
def _typical(table: bytes, shape: tuple[int, ...], low: bytes, high: bytes) -> float:
    model = np.frombuffer(table).reshape(shape).copy()  # kernels take what may be written
    postures = spread_postures(np.frombuffer(low), np.frombuffer(high), POSTURES_LOG2)
    return float(_squares(model, postures).mean())


@kernel
def _squares(model, postures):
    """|restoring wrench|^2 (k,) of the level vehicle in postures (k, n)."""
    out, level = np.zeros(postures.shape[0]), yaw_quaternion(0.0)
    for k in range(postures.shape[0]):
        wrench = restoring_wrench(model, level, postures[k])
        for i in range(6):
            out[k] += wrench[i] ** 2
    return out
