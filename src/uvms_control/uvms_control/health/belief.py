"""What is believed of each thruster: the user's word comes before the observer's estimate."""

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from uvms_control.allocation.allocator import GREATEST_SHARE, LEAST_SHARE
from uvms_control.errors import ControlSetupError
from uvms_core.errors import SignalError
from uvms_core.signals import ThrusterHealth

LEAST_LOSS = 0.25
"""Lost share from which an estimate is believed. Less is what the vehicle file does not know of a
healthy thruster, and the external wrench makes up for it."""
SIGMAS = 2.0
"""An estimate is believed where its loss is so many times its standard deviation; below, the
thruster is suspected."""
DEAD = 0.1
"""Estimated share below which a thruster is taken to be dead, and is not used any more."""

Source = Literal["", "configured", "told", "estimated"]


class ThrusterBelief:
    """Merges the words of users with the estimate.

    Args:
        names: of the thrusters, in the order of the vehicle file.
        configured: share by name, from the configuration.

    Raises:
        ControlSetupError: a name or a share that cannot be.
    """

    def __init__(self, names: Sequence[str], configured: Mapping[str, float]) -> None:
        self.names = tuple(names)
        self._said = np.full(len(self.names), np.nan)
        self._source: list[Source] = [""] * len(self.names)
        self._estimate = np.ones(len(self.names))
        self._seen = b""
        self._suspected = np.zeros(len(self.names), dtype=np.bool_)
        self.effectiveness = np.ones(len(self.names))
        """(m,) share of its command that each thruster is believed to give."""
        self._say(configured, "configured", "allocation.effectiveness")

    def say(self, shares: Mapping[str, float]) -> None:
        """Take the user's word by name; NaN takes a word back, and the estimate counts again.

        Raises:
            ControlSetupError: a name or a share that cannot be; nothing is taken then.
        """
        self._say(shares, "told", "thruster health")

    def _say(self, shares: Mapping[str, float], source: Source, what: str) -> None:
        for name, share in shares.items():
            _check(name, share, self.names, what)
        for name, share in shares.items():
            i = self.names.index(name)
            self._said[i], self._source[i] = share, "" if np.isnan(share) else source
        self._merge()

    def estimate(self, health: ThrusterHealth | None) -> None:
        """Take what the observer estimates; None: it does not look at the thrusters.

        A thruster that counts as weak is whole again once that is as certain as its loss was.

        Raises:
            SignalError: it has another number of thrusters.
        """
        if health is None:
            return
        seen = health.effectiveness.tobytes() + health.sigma.tobytes()
        if seen == self._seen:
            return
        if health.effectiveness.size != len(self.names):
            raise SignalError(
                f"thruster health: has {health.effectiveness.size} thrusters; the vehicle has"
                f" {len(self.names)}"
            )
        self._seen = seen
        lost = 1.0 - health.effectiveness
        is_lost = lost >= LEAST_LOSS
        share = np.where(is_lost, health.effectiveness, 1.0)
        share[health.effectiveness < DEAD] = 0.0
        certain = np.abs(health.effectiveness - self._estimate) >= SIGMAS * health.sigma
        self._estimate = np.where(certain, share, self._estimate)
        self._suspected = is_lost & ~certain & (self._estimate == 1.0)
        self._merge()

    def _merge(self) -> None:
        self.effectiveness = np.where(np.isnan(self._said), self._estimate, self._said)

    def source(self, name: str) -> Source:
        """Who says so of a thruster; "" where nobody does."""
        i = self.names.index(name)
        estimated: Source = "estimated" if self._estimate[i] != 1.0 else ""
        return self._source[i] or estimated

    @property
    def weak(self) -> dict[str, float]:
        """Thrusters that are not whole, with their share."""
        pairs = zip(self.names, self.effectiveness.tolist(), strict=True)
        return {name: share for name, share in pairs if share < 1.0}

    @property
    def suspected(self) -> tuple[str, ...]:
        """Thrusters that may be weak, of which nobody has said anything."""
        open_ = self._suspected & np.isnan(self._said)
        return tuple(name for name, is_open in zip(self.names, open_, strict=True) if is_open)

    @property
    def untried(self) -> NDArray[np.bool_]:
        """Thrusters (m,) bool that are taken to be dead by the estimate alone: not used, so that
        nothing would be seen of their recovery.
        """
        return np.isnan(self._said) & (self._estimate == 0.0)


def _check(name: str, share: float, names: Sequence[str], what: str) -> None:
    if name not in names:
        raise ControlSetupError(
            f"{what}: there is no thruster {name!r}; choose from {', '.join(names)}"
        )
    if not (np.isnan(share) or LEAST_SHARE <= share <= GREATEST_SHARE):
        raise ControlSetupError(
            f"{what}: {name}: {share:g} is not within {LEAST_SHARE:g} (dead) to"
            f" {GREATEST_SHARE:g} (1 is whole)"
        )
