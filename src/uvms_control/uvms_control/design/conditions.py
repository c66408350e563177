"""Conditions on the gains, checked before the first step.

Section 4.3 of the paper asks for positive gains and 0 < eps < lambda_min{K_d}, which makes the
error dynamics in continuous time stable (`stability.StabilityMonitor` takes eps in the middle). A
loop that is sampled, and whose thrusters lag, bears gains up to a bound only: the spectral radius
of the loop decides.
"""

from collections.abc import Callable, Sequence

from uvms_control.controlled_axes import AXES
from uvms_control.design.axis import Axis, AxisGains, loop_matrices
from uvms_control.design.margins import is_stable
from uvms_control.errors import ControlSetupError

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


def check_slopes(
    where: str, axes: Sequence[Axis | None], stiffness: Sequence[float], damping: Sequence[float]
) -> None:
    """Check slopes P, 1/s^2, and D, 1/s, of a feedback on the axes that it controls.

    `where`: section of the configuration that they come from.

    Raises:
        ControlSetupError: a slope is not positive, or the sampled loop is not stable with it.
    """
    for name, axis, p, d in zip(AXES, axes, stiffness, damping, strict=True):
        if axis is None:
            continue
        for gain, value in (("stiffness", p), ("damping", d)):
            if not value > 0.0:
                raise ControlSetupError(f"{where} {gain} of {name}: {value:g}, expected above 0")
        # Little stiffness first: what damping alone does not bear is not the stiffness's fault.
        _damping(f"{where} damping of {name}", axis, float(p), float(d))
        _stiffness(f"{where} stiffness of {name}", axis, float(p), float(d))


def _damping(gain: str, axis: Axis, stiffness: float, damping: float) -> None:
    soft = min(stiffness, (0.1 * damping) ** 2)
    require_stable(gain, damping, " 1/s", axis, lambda value: AxisGains(soft, value))


def _stiffness(gain: str, axis: Axis, stiffness: float, damping: float) -> None:
    require_stable(gain, stiffness, " 1/s^2", axis, lambda value: AxisGains(value, damping))
