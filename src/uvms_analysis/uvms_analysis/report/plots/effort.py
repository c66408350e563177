"""Plots of what the run cost: thrusts, wrench, authority left, torques, mechanical power."""

from functools import partial

import numpy as np

from uvms_analysis import effort
from uvms_analysis.errors import LogError
from uvms_analysis.report.plot import Curve, Limit, Panel, Part, panel, panels
from uvms_analysis.report.plots.disturbance import COMPONENTS
from uvms_analysis.report.run import ReportedRun
from uvms_core import topics


def thrusters(run: ReportedRun) -> list[Panel]:
    """Thrust of each thruster: as allocated, and as the plant's thruster gave it."""
    allocation = run.truth.allocation
    names = run.log.vehicle.thruster_names
    if allocation.thrust.shape[1:] != (len(names),):
        raise LogError("the allocation is not of this vehicle's thrusters")

    def allocated(index: int) -> Curve:
        return allocation.time, allocation.thrust[:, index]

    def applied(index: int) -> Curve:
        found = run.log.series(topics.APPLIED_THRUST)
        return found.time, found.thrust[:, index]

    return panels([
        partial(panel, f"thrust_{item.name}", f"thruster {item.name}", "N",
                [Part("allocated", partial(allocated, index)),
                 Part("given", partial(applied, index), "thin")],
                [Limit("astern", item.astern_n), Limit("ahead", item.ahead_n)], least=0.1)
        for index, item in enumerate(run.log.vehicle.thrusters)
    ])  # fmt: skip


def authority(run: ReportedRun) -> list[Panel]:
    """What the busiest thruster has left, and all thrust together."""
    of = run.truth

    def left() -> Curve:
        return of.allocation.time, 100.0 * effort.authority_left(of)

    def total() -> Curve:
        return of.allocation.time, effort.total_thrust(of)

    return panels([
        partial(panel, "authority", "left to the busiest thruster", "%",
                [Part("left", left)], [Limit("at a limit", 0.0)], least=5.0),
        partial(panel, "thrust_total", "all thrust, added up", "N", [Part("thrust", total)],
                least=0.1),
    ])  # fmt: skip


def wrench(run: ReportedRun) -> list[Panel]:
    """The wrench that the controller commands, and what the thrusters make of it."""

    def commanded(axis: int) -> Curve:
        found = run.log.series(topics.WRENCH_COMMAND)
        return found.time, found.wrench[:, axis]

    def achieved(axis: int) -> Curve:
        return run.truth.allocation.time, run.truth.allocation.achieved[:, axis]

    def missing(half: slice) -> Curve:
        allocation = run.truth.allocation
        return allocation.time, np.linalg.norm(allocation.residual[:, half], axis=1)

    axes = [
        partial(panel, f"wrench_{name}", f"wrench {name}", unit,
                [Part("commanded", partial(commanded, axis)),
                 Part("achieved", partial(achieved, axis), "thin")], least=0.05, peaks=True)
        for axis, (name, unit) in enumerate(COMPONENTS)
    ]  # fmt: skip
    lost = [
        partial(panel, f"wrench_missing_{kind}", f"{kind} commanded and not delivered", unit,
                [Part("missing", partial(missing, half))], least=1e-3, peaks=True)
        for kind, unit, half in (("force", "N", slice(0, 3)), ("moment", "N m", slice(3, 6)))
    ]  # fmt: skip
    return panels([*axes, *lost])


def torques(run: ReportedRun) -> list[Panel]:
    """Torque of each joint, commanded and measured."""

    def of_topic(topic: topics.Topic, index: int) -> Curve:
        found = run.log.series(topic)
        return found.time, found.effort[:, index]

    wanted = []
    for index, joint in enumerate(run.log.vehicle.arm.joints):
        parts = [
            Part("commanded", partial(of_topic, topics.JOINT_COMMAND, index)),
            Part("measured", partial(of_topic, topics.JOINT_STATES, index), "thin"),
        ]
        bounds = [Limit("limit", sign * joint.effort_limit_nm) for sign in (-1.0, 1.0)]
        wanted.append(partial(panel, f"torque_{joint.name}", f"torque of {joint.name}", "N m",
                              parts, bounds, least=0.02, peaks=True))  # fmt: skip
    return panels(wanted)


def power(run: ReportedRun) -> list[Panel]:
    """Mechanical power of thrusters and joints."""
    return panels([
        partial(panel, "power_thrusters", "thrusters on the vehicle, mechanical", "W",
                [Part("by the true velocity", lambda: effort.thruster_power(run.truth)),
                 Part("by the estimated velocity",
                      lambda: effort.thruster_power(run.seen), "thin")], least=0.01, peaks=True),
        partial(panel, "power_arm", "joints, mechanical", "W",
                [Part("commanded torque, measured rate", lambda: effort.arm_power(run.truth))],
                least=0.01, peaks=True),
    ])  # fmt: skip
