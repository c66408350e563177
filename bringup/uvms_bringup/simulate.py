"""`uvms simulate`: the closed loop in one process without ROS, logged as the graph's runs are."""

from collections.abc import Callable

from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.memory import MemoryWriter
from uvms_bringup.agenda import Agenda, Goals
from uvms_bringup.loop import Loop, LoopTick
from uvms_bringup.scenario import Scenario
from uvms_core import diagnostics, topics
from uvms_core.description import StateFrames, description_message, static_message
from uvms_core.diagnostics import Status
from uvms_core.signals import Goal, to_nanoseconds
from uvms_core.vehicle import Vehicle
from uvms_planner.errors import GoalRejected

Progress = Callable[[int, str], None]


def simulate(
    scenario: Scenario,
    vehicle: Vehicle,
    goal: Goals | Agenda,
    log: SignalWriter | MemoryWriter | None = None,
    progress: Progress = lambda stamp, text: None,
    observe: Callable[[LoopTick], None] = lambda tick: None,
) -> bool:
    """Run a scenario; True if it was completed.

    Args:
        goal: what the planner is asked for, once the loop is closed at the first tick: one goal,
            or several, of which each begins when the one before it has succeeded.
        log: receives every signal; None: no log.
        progress: called with the stamp in ns and what the run is at, at each tick.
        observe: called with every tick.

    Raises:
        GoalRejected: the planner cannot follow the goal.
        PlantDiverged: the state is not finite any more.
    """
    loop = Loop(scenario, vehicle)
    agenda = goal if isinstance(goal, Agenda) else Agenda(goal)
    frames = StateFrames(vehicle)
    end = to_nanoseconds(scenario.duration_s)
    if log is not None:
        write_description(log, vehicle)
    tick: LoopTick | None = None
    try:
        while True:
            tick = loop.tick()
            if log is not None:
                write_tick(log, tick, frames)
            observe(tick)
            if tick.plan is not None and tick.plan.finished is not None and agenda.active:
                finished = tick.plan.finished
                state = "succeeded" if finished.success else "aborted"
                agenda.end(tick.stamp, state, finished.message)
            progress(tick.stamp, _waiting(loop) if tick.odometry is None else agenda.phase)
            if tick.stamp >= end:
                return agenda.state in ("none", "running", "succeeded")
            if agenda.due is not None and tick.plan is not None:
                _begin(agenda, agenda.due, loop, tick.stamp)
            loop.advance(tick)
    finally:  # what was counted is known whatever ended the run
        if log is not None and tick is not None:
            for status in loop.final_status(tick):
                log.write(topics.DIAGNOSTICS, status)


def _waiting(loop: Loop) -> str:
    """What navigation waits for, for who watches the run."""
    trouble = loop.parts[topics.NAVIGATION].trouble()
    return "waiting for navigation" + ("" if trouble is None else f": {trouble[1]}")


def _begin(agenda: Agenda, goal: Goal, loop: Loop, stamp: int) -> None:
    """Begin a goal; a further one that is rejected ends the agenda, and the run goes on."""
    try:
        loop.planner.accept(goal)
    except GoalRejected as fault:
        if not agenda.begun:
            raise
        agenda.refuse(stamp, str(fault))
    else:
        agenda.begin(stamp)


def write_description(log: SignalWriter | MemoryWriter, vehicle: Vehicle) -> None:
    """What the graph publishes once, before the first tick."""
    log.write_plain(topics.ROBOT_DESCRIPTION, description_message(vehicle), 0)
    log.write_plain(topics.TF_STATIC, static_message(vehicle), 0)


def write_tick(log: SignalWriter | MemoryWriter, tick: LoopTick, frames: StateFrames) -> None:
    """Every message that the graph publishes in this tick."""
    for topic, signal in tick.outputs:
        log.write(topic, signal)
    joints = tick.sensors.joints
    if tick.odometry is not None:
        log.write_made(topics.TF, tick.stamp, frames.message, tick.odometry, joints)
    if tick.plan is not None:
        values = {"step_ms": tick.step_ms[topics.MOTION_PLANNER]} | tick.plan.diagnostics()
        log.write(
            topics.DIAGNOSTICS,
            Status(tick.stamp, topics.MOTION_PLANNER, diagnostics.OK, "ok", values),
        )
