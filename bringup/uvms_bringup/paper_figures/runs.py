"""The runs behind the figures."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.locate import log_path
from uvms_analysis.log.read import RunLog
from uvms_bringup.errors import RunError
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import effective_values, prepare
from uvms_core import topics
from uvms_core.errors import UvmsError

NEEDED = (
    topics.TRUE_ODOMETRY,
    topics.TRUE_JOINT_STATES,
    topics.TRUE_DISTURBANCE,
    topics.DISTURBANCE_BUDGET,
    topics.ODOMETRY,
    topics.JOINT_STATES,
    topics.ALLOCATION,
)
DURATION = "duration_s"
"""The only field of a scenario in which a run may differ from its recipe."""


@dataclass(frozen=True)
class Recipe:
    """A scenario with settings, as `uvms simulate` takes them."""

    scenario: str
    settings: tuple[str, ...] = ()

    @property
    def command(self) -> str:
        """What simulates it from a terminal."""
        return " ".join(["uvms simulate", self.scenario, *(f"--set {s}" for s in self.settings)])


FREE, BLIND, OBSERVED = "free", "blind", "observed"
MANIPULATION, ARM_ONLY = "manipulation", "arm_only"
RECIPES: Mapping[str, Recipe] = {
    FREE: Recipe("arm_swing", ("control.enabled=false",)),
    BLIND: Recipe("arm_swing", ("control.observer=false",)),
    OBSERVED: Recipe("arm_swing"),
    MANIPULATION: Recipe("manipulation"),
    ARM_ONLY: Recipe("manipulation", ("planner=arm_only",)),
}
"""By the name of the run's folder."""

Runs = Mapping[str, Analysis]


def simulated(
    folder: Path,
    duration_s: float | None = None,
    say: Callable[[str], None] = lambda line: None,
) -> Runs:
    """Simulate every recipe into a folder of its own, whole or for so long, s.

    Raises:
        RunError: a run did not do what it was asked for.
    """
    for name, recipe in RECIPES.items():
        say(recipe.command)
        scenario = load_scenario(recipe.scenario, recipe.settings, duration_s=duration_s)
        summary = prepare(scenario, str(folder / name), "lockstep", recipe.command).run_simulation()
        if duration_s is None and summary["outcome"] != "completed":
            reasons = "; ".join(summary["reasons"])
            raise RunError(f"{recipe.command}: {summary['outcome']}: {reasons}")
    return read(folder)


def read(folder: Path) -> Runs:
    """The runs in a folder.

    Raises:
        RunError: one is missing, or is not what its recipe says.
    """
    return {name: _read(folder / name, recipe) for name, recipe in RECIPES.items()}


def _read(folder: Path, recipe: Recipe) -> Analysis:
    try:
        log = RunLog.open(log_path(folder))
        log.load(NEEDED)  # in one pass
        scenario = load_scenario(recipe.scenario, recipe.settings)
        wanted = effective_values(scenario.for_vehicle(scenario.load_vehicle()))
        own = log.configuration()
    except UvmsError as fault:
        raise RunError(f"{folder}: holds no run of `{recipe.command}`: {fault}") from fault
    other = sorted(key for key in wanted if key != DURATION and own.get(key) != wanted[key])
    if other:
        raise RunError(
            f"{folder}: is no run of `{recipe.command}`: it has another {', '.join(other)}"
        )
    return Analysis(log)
