"""What is known of the velocity where no sensor tells it: how fast the vehicle can be at all.

Its speed through the water is bounded by thrust and drag, the water's own by the configuration. An
inertial unit that is left alone knows better at first, and worse in the end: a poor one after ten
seconds. So where the velocity has become that uncertain, the filter takes it to be zero with an
offset, v + o = 0, which is of first order (Gauss-Markov) with that std and changes within
`CHANGES_S`: the state of `lasting.py`, of a sensor that always reads zero.
"""

import numpy as np

from uvms_core.plausibility.agility import agility_of
from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.resistance import axis_resistance
from uvms_observer.navigation.measurements.base import Linear
from uvms_observer.navigation.state import SIZE, VELOCITY, NavigationState
from uvms_observer.navigation.trust import lasting
from uvms_observer.navigation.trust.following import Following
from uvms_observer.navigation.trust.lasting import NO_TURN, Lasting

CHANGES_S = 10.0
"""How long a vehicle keeps its velocity, s: legs of work are longer, turns and stops shorter."""
EVERY = to_nanoseconds(0.25)
"""Between two uses, ns: nothing is told but what the velocity has done meanwhile."""
BEGIN = 0.5
"""Of that std: from here on the estimate is so uncertain that it matters."""
END = 0.25
"""And from here on it does not any more."""
MOST_M_S = 5.0
"""For hulls with hardly any damping."""
IMPOSSIBLE = 5.0
"""Times that std along each axis: two and a half times the top speed. No vehicle has that."""
SURE = 3.0
"""Standard deviations of the estimate by which it is beyond that."""
NOISE_M_S = 1e-3
"""None; this keeps the covariance regular."""


def speed_std(vehicle: Vehicle, current: float) -> float:
    """Std of the horizontal velocity over ground along an axis, m/s: top speed is two of them.

    Args:
        vehicle: thrusters and drag, ahead or abeam, whichever is faster.
        current: std of that of the water, m/s.
    """
    linear, quadratic = axis_resistance(vehicle.hull, vehicle.environment.water_density_kg_m3)
    thrust = agility_of(vehicle).wrench
    top = max(
        2.0 * f / (a + np.sqrt(a**2 + 4.0 * b * f)) if a + b * f > 0.0 else MOST_M_S
        for a, b, f in zip(linear[:2], quadratic[:2], thrust[:2], strict=True)
    )
    return float(np.hypot(0.5 * min(top, MOST_M_S), current))


def bounded(state: NavigationState, kept: Lasting | None, std: float, stamp: int) -> Following:
    """The state at `stamp` (ns), and what is kept; None: the velocity is known well enough."""
    P = state.covariance[VELOCITY, VELOCITY]
    worst = float(np.sqrt(max(P[0, 0], P[1, 1])))
    sample = _at_rest(state)
    if kept is None:
        if worst < BEGIN * std or not lasting.has_room(state):
            return Following(state, None)
        new = Lasting("", std, NO_TURN, stamp, turned=np.pi, lasts=CHANGES_S)
        return Following(lasting.with_offset(state, sample), new)
    if worst < END * std:
        return Following(lasting.without_offset(state), None)
    kept = lasting.aged(state, kept, stamp)
    lasting.correct_by_changes(state, sample)
    return Following(state, kept)


def is_impossible(state: NavigationState, std: float) -> bool:
    """Whether the estimate is sure of a velocity that the vehicle cannot have: then it is wrong.

    Args:
        std: of its velocity along an axis, m/s.
    """
    if max(map(abs, state.velocity.tolist())) <= IMPOSSIBLE * std:  # the usual case, at once
        return False
    variance = np.diag(state.covariance)[VELOCITY]
    beyond = np.abs(state.velocity) - SURE * np.sqrt(np.maximum(variance, 0.0))
    return bool((beyond > IMPOSSIBLE * std).any())


def _at_rest(state: NavigationState) -> Linear:
    H = np.zeros((3, SIZE))
    H[:, VELOCITY] = np.eye(3)
    return Linear(-state.velocity, H, NOISE_M_S**2 * np.eye(3))
