"""What lasts: flags that have been up for some time without a break."""

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import to_nanoseconds


class Lasting:
    """Flags that count once they have been up for so many seconds.

    Args:
        seconds: for which a flag must be up without a break.
    """

    def __init__(self, seconds: float) -> None:
        self._span = to_nanoseconds(seconds)
        self._down: NDArray[np.int64] | None = None
        self.flags: NDArray[np.bool_] = np.zeros(0, dtype=np.bool_)
        """Those that have been up for so long."""

    def step(self, stamp: int, flags: NDArray[np.bool_]) -> None:
        """Take the flags at a stamp, ns."""
        if self._down is None or not flags.any():
            self._down = np.full(flags.size, stamp, dtype=np.int64)
        else:
            self._down = np.where(flags, self._down, stamp)
        self.flags = stamp - self._down >= self._span
