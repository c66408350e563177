"""Conditions on the gains, checked before the first step.

Section 4.3 of the paper asks for positive gains and 0 < eps < lambda_min{K_d}, which makes the
error dynamics in continuous time stable (`stability.StabilityMonitor` takes eps in the middle). A
loop that is sampled, and whose thrusters lag, bears gains up to a bound only: the spectral radius
of the loop decides.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

from uvms_control.controlled_axes import AXES
from uvms_control.design.axis import Axis, AxisGains, loop_matrices
from uvms_control.design.margins import is_stable
from uvms_control.errors import ControlSetupError
from uvms_core.signals import Array

BISECTIONS = 20
"""Halvings of the gain on the way to its bound: to 1e-6 of it."""


def require_stable(
    gain: str, value: float, unit: str, axis: Axis, gains_at: Callable[[float], AxisGains]
) -> None:
    """Refuse a gain that makes the loop of an axis unstable.

    Args:
        gain: its name in the configuration, with the axis.
        value: of the gain.
        unit: of the value, with the space before it.
        axis: the loop without gains.
        gains_at: gains of the axis by the value of this gain, the others as they are.

    Raises:
        ControlSetupError: names gain, value and bound.
    """

    def holds(tried: float) -> bool:
        return is_stable(loop_matrices(axis, gains_at(tried)).closed())

    if holds(value):
        return
    low, high = 0.0, value
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    lag = f"thrusters with {axis.lag:g} s of lag" if axis.lag > 0.0 else "no thruster lag"
    bound = f"at most {low:.3g}{unit}" if low > 0.0 else "no value of it is stable"
    raise ControlSetupError(
        f"{gain}: {value:.4g}{unit} makes the loop unstable, with a control period of"
        f" {axis.period:g} s and {lag}; {bound}"
    )


class Gains(NamedTuple):
    """Gains of a feedback on the six axes, by the name that they have in the configuration."""

    name: str
    values: Array  # (6,)
    slopes: Array  # (6,) of the acceleration near the reference, 1/s^2 or 1/s


def check_slopes(axes: Sequence[Axis | None], on_error: Gains, on_rate: Gains) -> None:
    """Check the gains on error (slopes P) and rate (slopes D) on the axes that are controlled.

    Raises:
        ControlSetupError: a gain is not positive, or the sampled loop is not stable with it.
    """
    for i, (name, axis) in enumerate(zip(AXES, axes, strict=True)):
        if axis is None:
            continue
        for gains in (on_error, on_rate):
            if not gains.slopes[i] > 0.0:
                raise ControlSetupError(
                    f"{gains.name} of {name}: {gains.values[i]:g}, expected above 0"
                )
        p, d = float(on_error.slopes[i]), float(on_rate.slopes[i])
        # Little stiffness first: what damping alone does not bear is not the stiffness's fault.
        soft = min(p, (0.1 * d) ** 2)
        _require(on_rate, i, axis, partial(AxisGains, soft))
        _require(on_error, i, axis, partial(AxisGains, damping=d))


def _require(gains: Gains, i: int, axis: Axis, at: Callable[[float], AxisGains]) -> None:
    value = float(gains.values[i])
    per_gain = float(gains.slopes[i]) / value
    name = f"{gains.name} of {AXES[i]}"
    require_stable(name, value, "", axis, lambda gain: at(per_gain * gain))
