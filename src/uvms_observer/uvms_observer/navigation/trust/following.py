"""What becomes of a sensor that has jumped away, sample by sample (`lasting.py` has the state).

Its samples count as rejected until it is right again. Meanwhile its changes are used, unless it
says nothing: where it reads zero, the same to the last bit, or what no vehicle does. Then the speed
that the vehicle can have at all is what is left to go by (`top_speed.py`).
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_observer.navigation.measurements.base import Linear
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.trust import lasting
from uvms_observer.navigation.trust.lasting import Lasting, Verdict

REST = 4.0
"""Standard deviations of its noise within which a sensor reads zero."""
MOST = 3.0
"""Std of the vehicle's own speed beyond which a jump leaves nothing to be learned from changes."""


class Following(NamedTuple):
    """The state, and what is kept of a sensor that is off; None: it is right again."""

    state: NavigationState
    kept: Lasting | None


def begun(
    state: NavigationState, name: str, sample: Linear, values: Array, stamp: int
) -> tuple[NavigationState, Lasting]:
    """After a jump at `stamp`, ns, to these values (3,)."""
    by, attitude = float(np.linalg.norm(sample.residual)), state.quaternion.copy()
    kept = Lasting(name, by, attitude, stamp, rests=_is_zero(values, sample))
    return lasting.with_offset(state, sample), kept


def stopped(state: NavigationState, kept: Lasting | None) -> NavigationState:
    """The state without what was kept."""
    return state if kept is None or not kept.carried else lasting.without_offset(state)


def silent(state: NavigationState, kept: Lasting) -> Following:
    """After a sample that says nothing: the next one that does may be right."""
    return Following(stopped(state, kept), kept._replace(carried=False, returns=False))


def followed(
    state: NavigationState, kept: Lasting, sample: Linear, values: Array, stamp: int
) -> Following:
    """After a further sample of this sensor at `stamp`, ns, with these values (3,)."""
    if not kept.carried:  # what it does now it has just begun to do
        return _returning(state, kept, sample, values, stamp, lasting.agrees(state, sample))
    kept = lasting.aged(state, kept, stamp)
    verdict, kept = lasting.judged(state, kept, sample)
    if verdict is Verdict.BACK:
        return Following(stopped(state, kept), None)
    if verdict is Verdict.GONE:
        alone = stopped(state, kept)
        return _returning(alone, kept, sample, values, stamp, kept.returns)
    lasting.correct_by_changes(state, sample)
    return Following(state, kept)


def _returning(
    state: NavigationState,
    kept: Lasting,
    sample: Linear,
    values: Array,
    stamp: int,
    returns: bool,
) -> Following:
    """After a further jump, back to where it is right or to something else."""
    state, new = begun(state, kept.name, sample, values, stamp)
    rests = new.rests and not returns
    return Following(state, new._replace(returns=returns, rests=rests, misfit=kept.misfit))


def says_nothing(values: Array, kept: Lasting, sample: Linear, speed: float) -> bool:
    """Whether a sensor that has jumped reads zero since then, or beyond what a vehicle does.

    A DVL that reads zero looks at what moves with the vehicle, whatever that does.

    Args:
        values: (3,) that it reads.
        kept, sample: of it.
        speed: std of what the vehicle can do, in the unit of the measurement.
    """
    rests = kept.rests and _is_zero(values, sample)
    return rests or float(np.linalg.norm(sample.residual)) > MOST * speed


def _is_zero(values: Array, sample: Linear) -> bool:
    noise = REST * np.sqrt(sample.N.diagonal())
    return bool((np.abs(values) < noise).all())
