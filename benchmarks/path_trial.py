"""One goal asked of the planner, and its references judged at 1 kHz against every limit."""

import time
from dataclasses import dataclass

import numpy as np
from method_paths import config_of, world_motion
from random_paths import RandomGoal
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array, JointStates, Odometry, Reference, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics import coupling_wrench, inverse_dynamics, restoring_wrench, rpy_to_quat
from uvms_dynamics.geometry import OWN, build_geometry, clearances_along
from uvms_dynamics.kernels.jit import kernel
from uvms_planner import GoalRejected, MotionPlanner
from uvms_planner.constraints import free_attitude
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.proposal import Proposal, silent
from uvms_planner.whole_path.surroundings import THRUST_FRACTION, thrust_shares

EACH_S = 1e-3
"""Between two samples of the references that are judged."""
NEAR_M = 0.03
"""Clearance of arm and hull that a plan keeps where its start does."""


@dataclass(frozen=True)
class Outcome:
    """What became of a goal, and what its references come to."""

    accepted: bool
    words: str  # of the refusal, or of the end
    seconds: float  # of wall time until it was accepted or refused
    finished: bool = False
    disturbance: float = np.nan  # J, N^2 s
    worst: float = np.nan  # share of the limit that they exceed most, or come nearest to
    limit: str = ""  # which
    tool_error: float = np.nan  # m
    clearance: float = np.nan  # m, least of arm from hull and from itself
    kept_clearance: float = np.nan  # m, the same of the pairs that begin beyond `NEAR_M`
    stop: float = np.nan  # rad, least distance from a joint's stop


class Trial:
    """Asks a planner with `method` for one goal, from where the goal begins."""

    def __init__(self, vehicle: Vehicle, goal: RandomGoal, method: str, each: float = EACH_S):
        self.vehicle, self.goal = vehicle, goal
        self.config = config_of(method).model_copy(update={"sample_s": each})
        self.planner = MotionPlanner(vehicle, self.config, 1)
        self._ticks = 0
        self.step()
        self.proposal: Proposal | None = None

    @property
    def solver(self):
        """What knows the limits that the plan is held to."""
        return self.planner._solver

    def step(self):
        """One tick of the planner; what it measures stays at the start."""
        start, still = self.goal.start, np.zeros(len(self.goal.start) - VEHICLE)
        stamp = to_nanoseconds(self._ticks * self.config.step_s)
        self._ticks += 1
        odometry = Odometry(
            stamp, start[:3].copy(), rpy_to_quat(0.0, 0.0, start[3]), np.zeros(6),
            np.zeros((6, 6)), np.zeros((6, 6)),
        )  # fmt: skip
        return self.planner.step(
            stamp, odometry, JointStates(stamp, start[VEHICLE:].copy(), still, still.copy())
        )

    def ask(self) -> tuple[str, float]:
        """The words of a refusal, or none; and how long it took, s."""
        began = time.perf_counter()
        try:
            self.proposal = self.planner.propose(self.goal.goal)
            self.proposal.work(silent)
        except GoalRejected as refusal:
            self.planner.withdraw()
            return str(refusal), time.perf_counter() - began
        return "", time.perf_counter() - began

    def follow(self) -> tuple[list[Reference], bool, str]:
        """The references of the goal that was accepted, whether it was reached, and the end."""
        self.planner.begin(self.proposal)
        motion = self.planner._goal
        references, result = [], None
        while result is None:
            step = self.step()
            references += step.references
            result = step.finished
        own = [r for r in references if motion.start <= r.stamp < motion.end]
        return own, result.success, result.message

    def outcome(self) -> Outcome:
        """Ask, follow and judge."""
        words, seconds = self.ask()
        if words:
            return Outcome(False, words, seconds)
        references, finished, end = self.follow()
        return self._judged(references, finished, end, seconds)

    def _judged(
        self, references: list[Reference], finished: bool, end: str, seconds: float
    ) -> Outcome:
        moved = [configurations_of(r) for r in references]
        c, v, a = (np.vstack(parts) for parts in zip(*moved, strict=True))
        worst, limit = self._worst(c, v, a, references)
        apart = self._own_clearances(c)
        joints = self.solver.joints
        stops = np.minimum(c[:, VEHICLE:] - joints.lower, joints.upper - c[:, VEHICLE:])
        return Outcome(
            True, end, seconds, finished,
            disturbance=disturbance_of(self.solver.model, references),
            worst=worst, limit=limit, tool_error=self._tool_error(references),
            clearance=float(apart.min()),
            kept_clearance=float(apart[:, apart[0] > NEAR_M].min(initial=np.inf)),
            stop=float(stops.min()),
        )  # fmt: skip

    def _worst(self, c: Array, v: Array, a: Array, references) -> tuple[float, str]:
        """The greatest share of any limit, and its name.

        Of a bound of the position, of the attitude and of a clearance: 1 + what it is exceeded by.
        """
        limits = self.solver.limits_from(c[0])
        low, high = np.minimum(limits.lower, c[0]), np.maximum(limits.upper, c[0])
        found = {
            "position": 1 + np.maximum(low - c, c - high).max(axis=0),
            "rate": np.abs(v).max(axis=0) / limits.rate,
            "acceleration": np.abs(a).max(axis=0) / limits.acceleration,
            "thruster": self._thrust(references),
            "clearance": 1 + self._too_close(c),
            "free attitude": 1 + self._tilt(c[:, VEHICLE:]),
            "turn of the tool": self._turn(c, references),
        }
        name = max(found, key=lambda each: found[each].max(initial=0.0))
        return float(found[name].max()), f"{name} {int(np.argmax(found[name]))}"

    def _thrust(self, references: list[Reference]) -> Array:
        """Greatest share of what each thruster may give."""
        shares = thrust_shares(self.vehicle, fraction=THRUST_FRACTION)
        needed = np.vstack([needed_wrenches(self.solver.model, *_motion(r)) for r in references])
        return np.abs(needed @ shares.T).max(axis=0)

    def _too_close(self, c: Array) -> Array:
        margins = self.solver.around_from(c[0]).margins
        geometry = build_geometry(self.vehicle, self.config.obstacles)
        return (margins - clearances_along(geometry, c)).max(axis=0)

    def _tilt(self, q: Array) -> Array:
        """How far the free attitude is beyond the limits, once it was within them."""
        limits = self.solver.motion_limits
        angles = np.abs([free_attitude(self.solver.model, each.copy()) for each in q[::10]])
        over = angles - [limits.roll_max, limits.pitch_max]
        inside = np.flatnonzero((over <= 0.0).all(axis=1))
        return over[inside[0] :].max(axis=0) if len(inside) else np.zeros(2)

    def _turn(self, c: Array, references: list[Reference]) -> Array:
        """Share of the tolerance by which the tool is turned from a prescribed orientation."""
        path, begin = self.proposal._path, to_seconds(references[0].stamp)
        if not path.oriented:
            return np.zeros(1)
        times = np.concatenate([to_seconds(r.stamp) - begin + r.times for r in references])
        wanted = Rotation.from_quat(path.samples(times[::10]).quaternion)
        turned = [tool_pose(self.solver.model, each.copy())[1] for each in c[::10]]
        off = (Rotation.from_matrix(turned) * wanted.inv()).magnitude()
        tolerance = np.deg2rad(self.config.projection.orientation_tolerance_deg)
        return np.array([off.max() / tolerance])

    def _own_clearances(self, c: Array) -> Array:
        geometry = build_geometry(self.vehicle)
        own = [pair.kind in OWN for pair in geometry.pairs]
        return clearances_along(geometry, c)[:, own]

    def _tool_error(self, references: list[Reference]) -> float:
        path, begin = self.proposal._path, to_seconds(references[0].stamp)
        errors = []
        for r in references:
            wanted = path.samples(to_seconds(r.stamp) - begin + r.times).position
            errors.append(np.linalg.norm(r.end_effector - wanted, axis=1).max())
        return float(max(errors))


def configurations_of(r: Reference) -> tuple[Array, Array, Array]:
    """Configuration, rate and acceleration (k, m) along a reference."""
    yaw = 2.0 * np.arctan2(r.quaternion[:, 2], r.quaternion[:, 3])
    return (np.column_stack([r.position, yaw, r.q]), *world_motion(r))


def _motion(r: Reference) -> tuple[Array, ...]:
    return tuple(
        np.ascontiguousarray(x) for x in (r.quaternion, r.nu, r.nu_dot, r.q, r.q_dot, r.q_ddot)
    )


def disturbance_of(model, references: list[Reference]) -> float:
    """J = integral of |restoring|^2 + |coupling|^2 along references, N^2 s, moments in N m."""
    return float(sum(np.trapezoid(_squares(model, *_motion(r)), r.times) for r in references))


@kernel
def _squares(model, quaternion, nu, nu_dot, q, q_dot, q_ddot):
    out = np.zeros(q.shape[0])
    for i in range(q.shape[0]):
        restoring = restoring_wrench(model, quaternion[i], q[i])
        coupling = coupling_wrench(model, nu[i], nu_dot[i], q[i], q_dot[i], q_ddot[i])
        out[i] = np.sum(restoring**2) + np.sum(coupling**2)
    return out


@kernel
def needed_wrenches(model, quaternion, nu, nu_dot, q, q_dot, q_ddot):
    """Wrench (k, 6) on the vehicle that a motion needs, in still water."""
    out = np.zeros((q.shape[0], 6))
    for i in range(q.shape[0]):
        out[i] = inverse_dynamics(
            model, quaternion[i], nu[i], nu_dot[i], q[i], q_dot[i], q_ddot[i]
        )[:6]
    return out
