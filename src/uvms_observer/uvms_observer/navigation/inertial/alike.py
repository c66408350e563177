"""Which samples of the inertial unit can be taken in one call (`at_once.py`)."""

from collections.abc import Callable, Sequence

from uvms_core.sensors import INERTIAL
from uvms_core.signals import ImuSample
from uvms_observer.navigation.inertial.installation import Stated
from uvms_observer.navigation.samples import Reading


def alike(
    readings: Sequence[Reading], excess_of: Callable[[ImuSample], Stated]
) -> tuple[list[ImuSample], Stated | None]:
    """The unit's samples that come first, with an attitude, and all as noisy as they say.

    Args:
        readings: in the order of their stamps.
        excess_of: what noise a sample states.

    Returns:
        The samples, and what they state; None where there are none.
    """
    samples: list[ImuSample] = []
    stated: Stated | None = None
    for reading in readings:
        if reading.name != INERTIAL.name or not reading.sample.oriented:
            break
        excess = excess_of(reading.sample)
        if stated is not None and excess != stated:
            break
        stated = excess
        samples.append(reading.sample)
    return samples, stated
