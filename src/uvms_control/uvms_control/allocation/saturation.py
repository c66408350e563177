"""Which thrusters are at their limits, and which axes fall short, and for how long."""

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_dynamics.kernels.jit import exact_kernel

SHORT = 0.01
"""Share of its authority by which an axis must fall short to count."""
MOST_PER_S = 1000
"""Commands a second for which the record has room; of more, only the last ones are remembered."""


class Shortage:
    """A record of the last seconds.

    Args:
        window_s: how far back it reaches, s.
        authority: (6,) N and N m, by which axes are compared; an axis with none never falls short.
        thrusters: their number m.
    """

    def __init__(self, window_s: float, authority: Array, thrusters: int) -> None:
        self._window = to_nanoseconds(window_s)
        self._least = np.where(authority > 0.0, SHORT * authority, np.inf)
        capacity, size = int(MOST_PER_S * window_s) + 1, thrusters + 6
        self._stamps = np.zeros(capacity, dtype=np.int64)
        self._lacks = np.zeros((capacity, size), dtype=np.bool_)
        self._counts, self._well = np.zeros((2, size), dtype=np.int64)
        self._place = np.zeros(2, dtype=np.int64)

    def reset(self) -> None:
        """Forget what was."""
        self._counts[:] = 0
        self._well[:] = 0
        self._place[:] = 0

    def note(self, stamp: int, saturated: NDArray[np.bool_], residual: Array) -> None:
        """What a tick's allocation says: thrusters at a limit (m,) and the residual (6,)."""
        note_shortage(
            self._stamps, self._lacks, self._counts, self._well, self._place, self._window, stamp,
            saturated, residual, self._least,
        )  # fmt: skip

    @property
    def thruster_share(self) -> Array:
        """(m,) share of the last seconds for which each thruster was at a limit, 0 to 1."""
        return self._counts[:-6] / max(self._place[1], 1)

    @property
    def axis_share(self) -> Array:
        """(6,) share of the last seconds for which each axis fell short of the command, 0 to 1."""
        return self._counts[-6:] / max(self._place[1], 1)

    @property
    def thruster_s(self) -> Array:
        """(m,) how long each thruster has been at a limit without a pause, s."""
        return self._lasted[:-6]

    @property
    def axis_s(self) -> Array:
        """(6,) how long each axis has fallen short without a pause, s."""
        return self._lasted[-6:]

    @property
    def _lasted(self) -> Array:
        newest = (self._place[0] + self._place[1] - 1) % self._stamps.size
        now = int(self._stamps[newest]) if self._place[1] else 0
        return np.array([to_seconds(now - stamp) for stamp in self._well.tolist()])


@exact_kernel
def note_shortage(stamps, lacks, counts, well, place, window, stamp, saturated, residual, least):
    """Add a tick to a ring of them, and drop those as old as the window (ns).

    `stamps` (k,) and `lacks` (k, m + 6) are the ring, `place` its first tick and their number;
    `counts` (m + 6,) how often each entry of those is true, `well` (m + 6,) the stamp at which
    each was last not true, or the first of all.
    """
    capacity, size = lacks.shape
    if place[1] == 0:
        for i in range(size):
            well[i] = stamp
    while place[1] > 0 and (place[1] == capacity or stamp - stamps[place[0]] >= window):
        for i in range(size):
            counts[i] -= lacks[place[0], i]
        place[0] = (place[0] + 1) % capacity
        place[1] -= 1
    new = (place[0] + place[1]) % capacity
    stamps[new] = stamp
    for i in range(size):
        lack = saturated[i] if i < size - 6 else abs(residual[i - size + 6]) > least[i - size + 6]
        lacks[new, i] = lack
        counts[i] += lack
        if not lack:
            well[i] = stamp
    place[1] += 1
