"""`uvms simulate`: the closed loop in one process without ROS, logged as the graph's runs are."""

from collections.abc import Callable, Sequence

from uvms_analysis.log.encode import SignalWriter
from uvms_bringup.loop import Loop, LoopTick
from uvms_bringup.scenario import Scenario
from uvms_core import diagnostics, topics
from uvms_core.description import StateFrames, description_message, static_message
from uvms_core.diagnostics import Status
from uvms_core.signals import JointGoal, PathGoal, Wrench, to_nanoseconds
from uvms_core.topic import Topic
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation.sensors.suite import in_order_of_publication
from uvms_planner import PlannerStep

Progress = Callable[[int, str], None]


def simulate(
    scenario: Scenario,
    vehicle: Vehicle,
    goal: PathGoal | JointGoal | None,
    log: SignalWriter | None = None,
    progress: Progress = lambda stamp, text: None,
    observe: Callable[[LoopTick], None] = lambda tick: None,
) -> bool:
    """Run a scenario; True if it came to its end.

    Args:
        goal: what the planner is asked for, once the loop is closed at the first tick.
        log: where every signal goes, None for nowhere.
        progress: called with the stamp in ns and a line of text, at each tick.
        observe: called with every tick.

    Raises:
        GoalRejected: the planner cannot follow the goal.
        PlantDiverged: the state is not finite any more.
    """
    loop = Loop(scenario, vehicle)
    frames, sensor_topics = StateFrames(vehicle), in_order_of_publication(vehicle)
    end = to_nanoseconds(scenario.duration_s)
    if log is not None:
        write_description(log, vehicle)
    succeeded = True
    while True:
        tick = loop.tick()
        if log is not None:
            write_tick(log, tick, frames, sensor_topics)
        observe(tick)
        progress(tick.stamp, "")
        if tick.plan is not None and tick.plan.finished is not None:
            succeeded = tick.plan.finished.success
        if tick.stamp >= end:
            return succeeded
        if tick.stamp == 0 and goal is not None:
            loop.planner.accept(goal)
        loop.advance(tick)


def write_description(log: SignalWriter, vehicle: Vehicle) -> None:
    """What the graph publishes once, before the first tick."""
    log.write_plain(topics.ROBOT_DESCRIPTION, description_message(vehicle), 0)
    log.write_plain(topics.TF_STATIC, static_message(vehicle), 0)


def write_tick(
    log: SignalWriter,
    tick: LoopTick,
    frames: StateFrames,
    sensor_topics: Sequence[tuple[str, Topic]],
) -> None:
    """Every message that the graph publishes in this tick."""
    sensors, truth = tick.sensors, tick.truth
    log.write(topics.CLOCK, tick.stamp)
    log.write(topics.TRUE_ODOMETRY, truth.odometry)
    log.write(topics.TRUE_JOINT_STATES, truth.joints)
    log.write(topics.TRUE_DISTURBANCE, truth.disturbance)
    log.write(topics.JOINT_STATES, sensors.joints)
    for name, topic in sensor_topics:
        for sample in sensors.samples[name]:
            log.write(topic, sample)
    log.write(topics.ODOMETRY, tick.odometry)
    log.write_plain(topics.TF, frames.message(tick.odometry, sensors.joints), tick.stamp)
    log.write(topics.DISTURBANCE, tick.disturbance)
    log.write(topics.DISTURBANCE_BUDGET, tick.budget)
    log.write(topics.WRENCH_COMMAND, tick.wrench)
    log.write(topics.JOINT_COMMAND, tick.joint_command)
    log.write(topics.THRUSTER_COMMAND, tick.thruster_command)
    log.write(topics.WRENCH_ACHIEVED, Wrench(tick.stamp, tick.allocation.achieved))
    log.write(topics.ALLOCATION, tick.allocation)
    if tick.plan is not None:
        _write_plan(log, tick.stamp, tick.plan, tick.plan_ms)


def _write_plan(log: SignalWriter, stamp: int, plan: PlannerStep, step_ms: float) -> None:
    for reference in plan.references:
        log.write(topics.REFERENCE, reference)
    values = {"step_ms": step_ms} | plan.diagnostics()
    log.write(topics.DIAGNOSTICS, Status(stamp, "motion_planner", diagnostics.OK, "ok", values))
