"""What a planner method must do to choose the steps along a path."""

from abc import abstractmethod
from typing import Protocol

from uvms_core.signals import Array
from uvms_planner.choice import Choice
from uvms_planner.problem import StepProblem


class StepMethod(Protocol):
    """Chooses the increment of the configuration c = (x, y, z, psi, q) for one planner step.

    The constructor is called with the vehicle (`uvms_core.vehicle.Vehicle`), the configuration
    (`PlannerConfig`) and the seed of the run. A class that derives from this protocol inherits
    `bounds` and `readiness`, which leave everything as it is. All methods share projection, limits
    and cost, which `StepSolver` puts into the problem.
    """

    def bounds(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Least and greatest increment (m,) that the method allows within those of the limits."""
        return lower, upper

    def readiness(self, readiness: Array) -> Array:
        """Inverse weights (m,) of the projection; a variable with zero is not moved by it."""
        return readiness

    @abstractmethod
    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The increment for a step; the same for the same problem, seed and `index`.

        Args:
            problem: where the motion is, what it may do, and where the end effector must be.
            index: number of the step in the run, for the random numbers.

        Returns:
            The choice; not valid, and as near to the path as possible, where the end effector
            cannot be within the tolerance of the path.
        """
        ...
