"""Whether a filter that began anywhere has found out where it is."""

import numpy as np

from uvms_observer.navigation.state import POSITION, VELOCITY, NavigationState

DEPTH = POSITION.stop - 1


def lacking(state: NavigationState, within_m: float, within_m_s: float) -> str:
    """What is not known yet, in words; empty where all is.

    Args:
        state: of the filter.
        within_m: largest std of north, east and depth, m.
        within_m_s: largest std of the velocity along each axis, m/s.
    """
    std = np.sqrt(np.diagonal(state.covariance))
    lacks = []
    if (worst := float(std[POSITION.start : DEPTH].max())) > within_m:
        lacks.append(
            _lack("a horizontal position (GPS, position fix or marker)", worst, within_m, "m")
        )
    if (worst := float(std[DEPTH])) > within_m:
        lacks.append(_lack("a depth (pressure or position fix)", worst, within_m, "m"))
    if (worst := float(std[VELOCITY].max())) > within_m_s:
        lacks.append(_lack("a velocity (DVL, or several fixes)", worst, within_m_s, "m/s"))
    return f"waiting for {', and for '.join(lacks)}" if lacks else ""


def _lack(what: str, std: float, within: float, unit: str) -> str:
    """With the std in two digits, so that the text does not change at every tick."""
    return f"{what}: std {float(f'{std:.1g}'):g} {unit}, must be below {within:g} {unit}"
