"""A synthetic log whose metrics are known beforehand.

The vehicle follows the path as a stiff body, arm at rest but for its last joint (a roll about the
tool's own axis), so that the end effector moves exactly as the vehicle does. On top of the path
comes a known error.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.goal_file import path_to_json
from uvms_analysis.log.writer import LogWriter
from uvms_core import topics
from uvms_core.diagnostics import Status
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import (
    Allocation,
    AppliedThrust,
    BatteryState,
    DisturbanceBudget,
    JointCommand,
    JointStates,
    Odometry,
    PathGoal,
    PlannedDisturbance,
    Reference,
    Stability,
    ThrusterCommand,
    Wrench,
    to_nanoseconds,
)
from uvms_core.vehicle import dump_vehicle, load_vehicle
from uvms_dynamics import build_model, end_effector
from uvms_dynamics.kernels.rotations import rpy_to_quat

PERIOD = 0.05
STEP = 0.5
ARM = np.array([0.2, 0.1, 1.4, 0.0])
RESTORING = np.array([0.0, 0.0, 3.0, 4.0, 0.0, 0.0])
COUPLING = np.array([0.0, 4.0, 0.0, 0.0, 3.0, 0.0])


@dataclass(frozen=True)
class Known:
    """What the log is made of."""

    duration: float = 40.0
    path_duration: float = 30.0
    start: float = 1.0
    error: float = 0.02  # m, amplitude along x, period 2 s
    navigation: float = 0.03  # m, constant along y
    roll_deg: float = 2.0  # amplitude, period 4 s
    pitch_deg: float = -1.5  # constant
    with_path: bool = True
    name_start: bool = True
    namespace: str = ""
    with_stability: bool = True
    plans_disturbance: bool = True  # 2 N along x and 1 N m about z less than the true one


def make_path(known: Known, start: np.ndarray) -> PathGoal:
    """A round of 0.3 m by 0.2 m in the vertical plane."""
    times = np.arange(0.0, known.path_duration + 1.0)
    s = times / known.path_duration
    angle = 2.0 * np.pi * s**3 * (10 - 15 * s + 6 * s**2)
    offsets = np.column_stack([0.2 * np.sin(angle), 0.0 * angle, 0.3 * (1 - np.cos(angle))])
    return PathGoal(times, start + offsets, np.empty((0, 4)))


class Synthetic:
    """Writes the log, signal by signal."""

    def __init__(self, known: Known) -> None:
        self.known = known
        self.vehicle = load_vehicle()
        self.model = build_model(self.vehicle)
        tool = self.tool(np.array([0.0, 0.0, 10.0]), self.attitude(0.0))
        self.path = make_path(known, tool)
        self.curve = EndEffectorPath(self.path)

    def tool(self, position: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
        return end_effector(self.model, position, quaternion, ARM)[0]

    def attitude(self, time: float) -> np.ndarray:
        roll = self.known.roll_deg * np.sin(2 * np.pi * time / 4.0)
        return rpy_to_quat(np.deg2rad(roll), np.deg2rad(self.known.pitch_deg), 0.0)

    def target(self, time: float) -> np.ndarray:
        return self.curve.positions(np.array([time - self.known.start]))[0]

    def error(self, time: float) -> np.ndarray:
        return np.array([self.known.error * np.sin(np.pi * time), 0.0, 0.0])

    def position(self, time: float) -> np.ndarray:
        """Where the vehicle is, so that the end effector is where it should be plus the error."""
        lever = self.tool(np.zeros(3), self.attitude(time))
        return self.target(time) + self.error(time) - lever

    def odometry(self, stamp: int, time: float, offset: np.ndarray) -> Odometry:
        variance = np.diag([1e-4, 4e-4, 1e-4, 1e-6, 1e-6, 1e-6])
        return Odometry(
            stamp,
            self.position(time) + offset,
            self.attitude(time),
            np.zeros(6),
            variance,
            variance,
        )

    def reference(self, stamp: int, time: float) -> Reference:
        times = np.arange(11) * PERIOD
        position = np.array([self.position(time + t) - self.error(time + t) for t in times])
        zeros = np.zeros((11, 6))
        joints = np.tile(ARM, (11, 1))
        return Reference(
            stamp,
            np.round(times, 9),
            position,
            np.array([self.attitude(time + t) for t in times]),
            zeros,
            zeros,
            joints,
            0.0 * joints,
            0.0 * joints,
            np.array([self.target(time + t) for t in times]),
            self.planned_disturbance(len(times)) if self.known.plans_disturbance else None,
        )

    @staticmethod
    def planned_disturbance(count: int) -> PlannedDisturbance:
        restoring = RESTORING - np.array([2.0, 0.0, 0.0, 0.0, 0.0, 1.0])
        return PlannedDisturbance(np.tile(restoring, (count, 1)), np.tile(COUPLING, (count, 1)))

    def joints(self, stamp: int, time: float) -> JointStates:
        roll = np.array([0.0, 0.0, 0.0, 0.5 * np.sin(0.2 * time)])
        return JointStates(stamp, ARM + roll, np.zeros(4), np.zeros(4))

    def tick(self, log: SignalWriter, number: int) -> None:
        time = number * PERIOD
        stamp = to_nanoseconds(time)
        log.write(topics.CLOCK, stamp)
        log.write(topics.TRUE_ODOMETRY, self.odometry(stamp, time, np.zeros(3)))
        offset = np.array([0.0, self.known.navigation, 0.0])
        log.write(topics.ODOMETRY, self.odometry(stamp, time, offset))
        for topic in (topics.JOINT_STATES, topics.TRUE_JOINT_STATES):
            log.write(topic, self.joints(stamp, time))
        restoring, coupling = RESTORING, COUPLING
        budget = DisturbanceBudget(stamp, restoring, coupling, np.zeros(6))
        log.write(topics.TRUE_DISTURBANCE, budget)
        log.write(topics.DISTURBANCE_BUDGET, budget)
        wrench = Wrench(stamp, restoring + coupling)
        for topic in (topics.DISTURBANCE, topics.WRENCH_COMMAND, topics.WRENCH_ACHIEVED):
            log.write(topic, wrench)
        thrust = 10.0 * np.sin(0.3 * time + np.arange(len(self.vehicle.thruster_names)))
        saturated = np.zeros(len(thrust), dtype=bool)
        saturated[0] = number % 4 == 0
        log.write(topics.JOINT_COMMAND, JointCommand(stamp, np.zeros(4)))
        log.write(topics.THRUSTER_COMMAND, ThrusterCommand(stamp, thrust))
        log.write(
            topics.ALLOCATION, Allocation(stamp, thrust, wrench.wrench, 0 * restoring, saturated)
        )
        if self.known.with_stability:
            # V halves every half second; the condition holds at even ticks.
            value = float(4.0 * 0.5 ** (2.0 * time))
            rate = float(-2.0 * np.log(2.0) * value)
            log.write(topics.STABILITY, Stability(stamp, value, rate, 1.0, 2.0 - number % 2 * 1.5))
        before = max(stamp - to_nanoseconds(PERIOD), 0)
        applied = AppliedThrust(stamp, thrust, thrust, before, before, number == 0, number == 0)
        log.write(topics.APPLIED_THRUST, applied)
        if number % round(topics.BATTERY_PERIOD_S / PERIOD) == 0:
            share = 1.0 - time / 1024.0  # in binary, so that 32 bits hold it
            log.write(
                topics.BATTERY_STATE, BatteryState(stamp, 48.0, -2.0, 64 * share, 64.0, share)
            )
        if number % 10 == 0:
            self.plan(log, number, stamp, time)

    def plan(self, log: SignalWriter, number: int, stamp: int, time: float) -> None:
        log.write(topics.REFERENCE, self.reference(stamp, time), stamp)
        share = 1.0 / (number // 10 + 2)
        values: dict[str, float] = {"step_ms": float(number // 10 + 1), "manipulability": share}
        if self.known.name_start:
            values["elapsed_s"] = time - self.known.start
        log.write(topics.DIAGNOSTICS, Status(stamp, "motion_planner", values=values))
        log.write(topics.DIAGNOSTICS, Status(stamp, "plant", values={"lockstep_timeouts": 2}))


def write_log(path: Path, known: Known = Known()) -> Synthetic:
    """Write the log and return what it was made from."""
    run = Synthetic(known)
    names = run.vehicle.joint_names, run.vehicle.thruster_names
    with LogWriter(path) as log:
        log.attach("config.yaml", "scenario: synthetic\nseed: 7\n")
        log.attach("vehicle.yaml", dump_vehicle(run.vehicle))
        if known.with_path:
            log.attach("path.json", path_to_json(run.path))
        log.metadata("uvms", {"scenario": "synthetic", "seed": 7, "git_revision": "abc"})
        signals = SignalWriter(log, *names, known.namespace)
        for number in range(round(known.duration / PERIOD) + 1):
            run.tick(signals, number)
    return run
