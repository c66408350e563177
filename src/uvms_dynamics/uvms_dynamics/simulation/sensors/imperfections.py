"""Errors that all sensors have in common: bias, random walk, scale, mounting, rounding, outliers.

Each kind of error of each sensor has its own generator of random numbers, so that none shifts
another's, and a vehicle without them has the numbers that it had before they were thought of.
"""

from collections.abc import Sequence

import numpy as np

from uvms_core.rng import generator
from uvms_core.signals import Array, to_seconds
from uvms_dynamics.kernels.rotations import quat_to_matrix, rotation_vector_to_quat

Std = Array | Sequence[float] | float


class Errors:
    """Errors of a measured vector (k,), in its own unit; stds and sizes are numbers or (k,).

    Args:
        seed: of the run.
        sensor: name, for its generators.
        size: k.
        bias: std of the constant bias.
        walk: std of the random walk after one second.
        scale: std of the constant scale error.
        resolution: step of rounding; 0 for none.
        outlier: std of what an outlier adds.
        outlier_rate: probability of one.
    """

    def __init__(
        self,
        seed: int,
        sensor: str,
        size: int,
        *,
        bias: Std = 0.0,
        walk: Std = 0.0,
        scale: Std = 0.0,
        resolution: Std = 0.0,
        outlier: Std = 0.0,
        outlier_rate: float = 0.0,
    ) -> None:
        name = f"sensors/{sensor}"
        self._walk_std, self._outlier = _full(walk, size), _full(outlier, size)
        self._resolution = _full(resolution, size)
        self._rate = outlier_rate if self._outlier.any() else 0.0
        self._walks = generator(seed, f"{name}/walk")
        self._strikes = generator(seed, f"{name}/outlier")
        self._offset = _drawn(seed, f"{name}/bias", _full(bias, size))
        self._factor = 1.0 + _drawn(seed, f"{name}/scale", _full(scale, size))
        self._stamp: int | None = None
        self.scales = bool((self._factor != 1.0).any())
        self.adds = bool(self._offset.any() or self._walk_std.any() or self._rate > 0.0)
        self.rounds = bool(self._resolution.any())

    @property
    def exist(self) -> bool:
        """Whether there are errors at all."""
        return self.scales or self.adds or self.rounds

    def scaled(self, true: Array) -> Array:
        """The true vector (k,) with the scale error."""
        return self._factor * true if self.scales else true

    def added(self, stamp: int) -> Array:
        """Bias, walk and outlier (k,) of the sample of this stamp, ns; stamps must rise."""
        if self._walk_std.any():
            elapsed = 0.0 if self._stamp is None else to_seconds(stamp - self._stamp)
            self._stamp = stamp
            step = self._walks.standard_normal(self._offset.size)
            self._offset = self._offset + self._walk_std * np.sqrt(elapsed) * step
        if self._rate > 0.0:
            struck = self._strikes.random() < self._rate
            size = self._strikes.standard_normal(self._offset.size)
            if struck:
                return self._offset + self._outlier * size
        return self._offset

    def rounded(self, measured: Array) -> Array:
        """The measured vector (k,) in steps of the resolution."""
        if not self.rounds:
            return measured
        step = np.where(self._resolution > 0.0, self._resolution, 1.0)
        return np.where(self._resolution > 0.0, step * np.round(measured / step), measured)

    def completed(self, stamp: int, noisy: Array) -> Array:
        """What is measured (k,) where scale and noise are in it already."""
        return self.rounded(noisy + self.added(stamp) if self.adds else noisy)


def misalignment(seed: int, sensor: str, std_deg: float) -> Array | None:
    """R_body_sensor (3, 3) of a mount that is off by this std about each axis; None: by nothing."""
    if std_deg == 0.0:
        return None
    turn = _drawn(seed, f"sensors/{sensor}/misalignment", np.radians(_full(std_deg, 3)))
    return quat_to_matrix(rotation_vector_to_quat(turn))


def _full(value: Std, size: int) -> Array:
    return np.broadcast_to(np.asarray(value, dtype=float), (size,)).copy()


def _drawn(seed: int, name: str, std: Array) -> Array:
    return (
        std * generator(seed, name).standard_normal(std.size) if std.any() else np.zeros(std.size)
    )
