"""Which thrusters are at their limits, and which axes fall short, and for how long."""

from collections import deque

import numpy as np

from uvms_core.signals import Array, to_nanoseconds, to_seconds

SHORT = 0.01
"""Share of its authority by which an axis must fall short to count."""


class Shortage:
    """A record of the last seconds.

    Args:
        window_s: how far back it reaches, s.
        authority: (6,) N and N m, by which axes are compared; the record of an axis with none is 0.
        thrusters: their number m.
    """

    def __init__(self, window_s: float, authority: Array, thrusters: int) -> None:
        self._window = to_nanoseconds(window_s)
        self._least = np.where(authority > 0.0, SHORT * authority, np.inf)
        self._size = thrusters + 6
        self.reset()

    def reset(self) -> None:
        """Forget what was."""
        self._ticks: deque[tuple[int, Array]] = deque()
        self._counts = np.zeros(self._size, dtype=np.int64)
        self._now: int | None = None
        self._well = np.zeros(self._size, dtype=np.int64)  # stamps when last it was not short

    def note(self, stamp: int, saturated: Array, residual: Array) -> None:
        """What a tick's allocation says: thrusters at a limit (m,) and the residual (6,)."""
        lacks = np.empty(self._size, dtype=np.bool_)
        lacks[:-6] = saturated
        np.greater(np.abs(residual), self._least, out=lacks[-6:])
        self._ticks.append((stamp, lacks))
        self._counts += lacks
        while stamp - self._ticks[0][0] >= self._window:
            self._counts -= self._ticks.popleft()[1]
        np.copyto(self._well, stamp, where=~lacks if self._now is not None else True)
        self._now = stamp

    @property
    def thruster_share(self) -> Array:
        """(m,) share of the last seconds for which each thruster was at a limit, 0 to 1."""
        return self._counts[:-6] / max(len(self._ticks), 1)

    @property
    def axis_share(self) -> Array:
        """(6,) share of the last seconds for which each axis fell short of the command, 0 to 1."""
        return self._counts[-6:] / max(len(self._ticks), 1)

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
        now = 0 if self._now is None else self._now
        return np.array([to_seconds(now - stamp) for stamp in self._well.tolist()])
