"""The health of each sensor, as the filter sees it."""

from collections.abc import Mapping
from enum import Enum

from uvms_core.diagnostics import WARN, Trouble
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.trust.innovation_gate import Tally

SILENT_PERIODS = 10.0
"""Periods without a sample after which a sensor is lost."""
SILENT_S = 1.0
"""The same, at least, s."""


class Health(Enum):
    """Good, or why not."""

    GOOD = "good"
    SUSPECT = "suspect"  # its last samples were beyond the gate
    EXCLUDED = "excluded"  # several in a row were; none is used
    LOST = "lost"  # there have been no samples for long
    OUT_OF_REACH = "out of reach"  # nor can there be any where the vehicle is


def health_of(tally: Tally, silent_s: float, period_s: float) -> Health:
    """Of a sensor whose last sample was `silent_s` ago."""
    if silent_s > max(SILENT_S, SILENT_PERIODS * period_s):
        return Health.LOST
    if tally.excluded:
        return Health.EXCLUDED
    return Health.SUSPECT if tally.row else Health.GOOD


def excused(health: Health, measurement: Measurement, state: NavigationState) -> Health:
    """The health, with a sensor that is silent as it must be told from one that is lost."""
    if health is Health.LOST and measurement.out_of_reach(state):
        return Health.OUT_OF_REACH
    return health


def joined(*troubles: Trouble | None) -> Trouble | None:
    """Several as one, of the highest of their levels; None where there is none."""
    found = [each for each in troubles if each is not None]
    if not found:
        return None
    return Trouble(max(each.level for each in found), "; ".join(each.text for each in found))


def trouble_of(health: Mapping[str, Health]) -> Trouble | None:
    """What there is to say of the sensors that are not used; None where all are."""
    excluded = [name for name, each in health.items() if each is Health.EXCLUDED]
    lost = [name for name, each in health.items() if each is Health.LOST]
    texts = []
    if excluded:
        texts.append(f"excluded, since their samples do not fit: {', '.join(excluded)}")
    if lost:
        texts.append(f"no samples: {', '.join(lost)}")
    return Trouble(WARN, "; ".join(texts)) if texts else None
