"""Stability of the vehicle's loop along a run: the `stability` of the summary."""

from collections.abc import Callable

import numpy as np

from uvms_analysis.analysis import Analysis
from uvms_core.signals import Array

NAMES = (
    "condition_holds",
    "lyapunov_falls",
    "lyapunov_max",
    "lyapunov_end",
    "lyapunov_rms",
)


def stability(run: Analysis, at_end: Callable[[Array, Array], dict]) -> dict[str, float | None]:
    """Shares of the ticks, and sizes of V of eq. (27), by the controller's own account.

    `condition_holds`: share in which the condition below (29) holds, which is sufficient and not
    necessary; `lyapunov_falls`: share in which V does not grow by the model with the wrench that
    the thrusters gave; `lyapunov_end`: greatest V at the end of the run.

    Raises:
        LogError: the controller reports nothing of it, as those of other packages may.
    """
    found = run.stability
    value = found.lyapunov
    return {
        "condition_holds": float(np.mean(found.supply >= found.demand)),
        "lyapunov_falls": float(np.mean(found.lyapunov_rate <= 0.0)),
        "lyapunov_max": float(np.max(value)),
        "lyapunov_end": at_end(value, found.time)["end"],
        "lyapunov_rms": float(np.sqrt(np.mean(value**2))),
    }
