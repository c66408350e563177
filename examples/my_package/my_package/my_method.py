"""A planner method: keep the motion of the step before, and correct it onto the path."""

from pydantic import Field

from uvms_core.config import Config
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model
from uvms_planner import Choice, PlannerConfig, StepMethod, nearest_on_path
from uvms_planner.problem import StepProblem


class MyMethod(StepMethod):
    """Projects a share of the last increment onto the path, so that the motion stays smooth.

    It inherits `bounds` and `readiness` from `StepMethod`: it uses all that the limits allow.
    """

    class Parameters(Config):
        """Set by `planner.parameters.NAME`."""

        memory: float = Field(
            0.9, ge=0.0, le=1.0, description="share of the last step's motion that goes on, no unit"
        )

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int) -> None:
        self._model = build_model(vehicle)
        self._memory = config.parameters.memory

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The increment on the path that is nearest to the one of the step before."""
        return nearest_on_path(self._model, problem, self._memory * problem.previous)
