"""Which limits a step exceeds, and by how much."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_planner.problem import VEHICLE, StepProblem

ROUNDING = 1e-9  # of a limit: less beyond it is rounding
VEHICLE_NAMES = ("x", "y", "z", "yaw")


@dataclass(frozen=True)
class LimitExceeded:
    """A limit of one variable that a step exceeds."""

    name: str  # such as "acceleration of elbow"
    value: float  # in `unit`
    bound: float  # in `unit`
    unit: str

    @property
    def ratio(self) -> float:
        """The value over the bound; infinite where the bound is zero."""
        return self.value / self.bound if self.bound > 0.0 else np.inf

    def __str__(self) -> str:
        return f"{self.name} {self.value:.4g} {self.unit}, allowed {self.bound:.4g} {self.unit}"


def limits_exceeded(
    problem: StepProblem, increment: Array, joints: tuple[str, ...]
) -> tuple[LimitExceeded, ...]:
    """What the increment (m,) exceeds of the bounds in `problem`, the most exceeded first.

    The accelerations, as changes of the increment; and where those are kept, the speed at which a
    variable could still stop before the end of its range.
    """
    found = []
    for i, name in enumerate((*VEHICLE_NAMES, *joints)):
        scale, length = (1.0, "m") if i < VEHICLE - 1 else (np.rad2deg(1.0), "deg")
        change, jump = abs(increment[i] - problem.previous[i]), problem.jump[i]
        beyond = max(increment[i] - problem.upper[i], problem.lower[i] - increment[i])
        if change > jump * (1.0 + ROUNDING):
            per = scale / problem.step**2
            found.append(
                LimitExceeded(
                    f"acceleration of {name}",
                    float(change * per),
                    float(jump * per),
                    f"{length}/s^2",
                )
            )
        elif beyond > ROUNDING * problem.reach[i]:
            per = scale / problem.step
            speed = abs(increment[i])
            found.append(
                LimitExceeded(
                    f"speed of {name} before the end of its range",
                    float(speed * per),
                    float(max(speed - beyond, 0.0) * per),
                    f"{length}/s",
                )
            )
    return tuple(sorted(found, key=lambda limit: -limit.ratio))
