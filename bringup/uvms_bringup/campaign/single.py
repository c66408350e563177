"""One run in memory: its summary without a log file."""

from typing import Any

from uvms_analysis.log.memory import MemoryWriter
from uvms_analysis.summary import LOADED, summarise
from uvms_bringup.agenda import path_of
from uvms_bringup.ending import Ending
from uvms_bringup.pace import Pace
from uvms_bringup.scenario import Scenario
from uvms_bringup.session import Stopwatch, effective_values, run_records, simulate_goal
from uvms_core.errors import UvmsError
from uvms_dynamics.simulation.plant.as_built import as_built
from uvms_planner.errors import GoalRejected


def summary_of(scenario: Scenario) -> dict[str, Any]:
    """The summary of a run, the same as `uvms simulate` makes from its log.

    Raises:
        UvmsError: the run cannot begin; one that ends early has a summary that says so.
    """
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    goal = scenario.build_goals(vehicle)
    writer, ending, clock = MemoryWriter(vehicle, LOADED), Ending(), Stopwatch()
    stopped_by = ""
    try:
        simulate_goal(scenario, vehicle, goal, writer, ending, lambda stamp, text: clock.start())
    except UvmsError as fault:
        clock.stop()
        if clock.run_s == 0.0 or isinstance(fault, GoalRejected):
            raise
        stopped_by = str(fault)
    clock.stop()
    if not stopped_by:
        ending.sent = writer.counts
    built = as_built(vehicle, scenario.plant, scenario.seed)
    end = ending.record(scenario.duration_s, stopped_by)
    log = writer.log(
        run_records(scenario, built, str(Pace())),
        effective_values(scenario),
        path_of(goal),
        end,
        built.vehicle if built.differs else None,
    )
    return summarise(log, wall_s=clock.run_s)
