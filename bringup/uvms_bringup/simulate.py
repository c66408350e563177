"""`uvms simulate`: the closed loop in one process without ROS, logged as the graph's runs are."""

from collections.abc import Callable

from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.memory import MemoryWriter
from uvms_bringup.loop import Loop, LoopTick
from uvms_bringup.scenario import Scenario
from uvms_core import diagnostics, topics
from uvms_core.description import StateFrames, description_message, static_message
from uvms_core.diagnostics import Status
from uvms_core.signals import Goal, to_nanoseconds
from uvms_core.vehicle import Vehicle

Progress = Callable[[int, str], None]


def simulate(
    scenario: Scenario,
    vehicle: Vehicle,
    goal: Goal | None,
    log: SignalWriter | MemoryWriter | None = None,
    progress: Progress = lambda stamp, text: None,
    observe: Callable[[LoopTick], None] = lambda tick: None,
) -> bool:
    """Run a scenario; True if it was completed.

    Args:
        goal: what the planner is asked for, once the loop is closed at the first tick.
        log: receives every signal; None: no log.
        progress: called with the stamp in ns and a line of text, at each tick.
        observe: called with every tick.

    Raises:
        GoalRejected: the planner cannot follow the goal.
        PlantDiverged: the state is not finite any more.
    """
    loop = Loop(scenario, vehicle)
    frames = StateFrames(vehicle)
    end = to_nanoseconds(scenario.duration_s)
    if log is not None:
        write_description(log, vehicle)
    succeeded = True
    tick: LoopTick | None = None
    try:
        while True:
            tick = loop.tick()
            if log is not None:
                write_tick(log, tick, frames)
            observe(tick)
            progress(tick.stamp, "")
            if tick.plan is not None and tick.plan.finished is not None:
                succeeded = tick.plan.finished.success
            if tick.stamp >= end:
                return succeeded
            if tick.stamp == 0 and goal is not None:
                loop.planner.accept(goal)
            loop.advance(tick)
    finally:  # what was counted is known whatever ended the run
        if log is not None and tick is not None:
            for status in loop.final_status(tick):
                log.write(topics.DIAGNOSTICS, status)


def write_description(log: SignalWriter | MemoryWriter, vehicle: Vehicle) -> None:
    """What the graph publishes once, before the first tick."""
    log.write_plain(topics.ROBOT_DESCRIPTION, description_message(vehicle), 0)
    log.write_plain(topics.TF_STATIC, static_message(vehicle), 0)


def write_tick(log: SignalWriter | MemoryWriter, tick: LoopTick, frames: StateFrames) -> None:
    """Every message that the graph publishes in this tick."""
    for topic, signal in tick.outputs:
        log.write(topic, signal)
    joints = tick.sensors.joints
    log.write_made(topics.TF, tick.stamp, frames.message, tick.odometry, joints)
    if tick.plan is not None:
        values = {"step_ms": tick.step_ms[topics.MOTION_PLANNER]} | tick.plan.diagnostics()
        log.write(
            topics.DIAGNOSTICS,
            Status(tick.stamp, topics.MOTION_PLANNER, diagnostics.OK, "ok", values),
        )
