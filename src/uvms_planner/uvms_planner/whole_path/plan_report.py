"""What a plan costs, and how much of each limit it takes."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.sample import ATTITUDE, POSITION, THRUST, TURN, WRENCHES

FORGIVEN = 1e-3  # share by which a limit may be exceeded
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class LimitShare:
    """Where a plan comes nearest to one limit."""

    name: str  # such as "rate of joint 2"
    share: float  # 1 at the limit
    time: float  # s after the beginning
    value: float  # SI and rad
    limit: float


@dataclass(frozen=True)
class PlanReport:
    """Cost and limits of a plan."""

    disturbance: float  # J, integral of the squared restoring and coupling wrench
    force_rms: float  # N, of their sum
    moment_rms: float  # N m
    limits: tuple[LimitShare, ...]  # the worst first

    @property
    def worst(self) -> LimitShare:
        """The limit that the plan comes nearest to, or exceeds most."""
        return self.limits[0]

    @property
    def feasible(self) -> bool:
        """Whether every limit is kept."""
        return self.worst.share <= 1 + FORGIVEN


def report_of(problem: PathProblem, times: Array, posture: Array, values: Array) -> PlanReport:
    """The report of posture (k, 3, d) and values (k, v) of `sample` at even `times` (k,)."""
    wrenches = values[:, :WRENCHES]
    total = wrenches[:, :6] + wrenches[:, 6:]
    squares = np.sum(wrenches**2, axis=1)
    shares = sorted(_shares(problem, times, posture, values), key=lambda s: -s.share)
    return PlanReport(
        float(np.trapezoid(squares, times)),
        _rms(total[:, :3]),
        _rms(total[:, 3:]),
        tuple(shares),
    )


def _rms(vectors: Array) -> float:
    return float(np.sqrt(np.mean(np.sum(vectors**2, axis=1))))


def _shares(problem: PathProblem, times: Array, posture: Array, values: Array):
    limits, n = problem.limits, problem.size - 1
    names = [f"{axis} of the vehicle" for axis in AXES] + ["the yaw"]
    names += [f"joint {i + 1}" for i in range(n)]
    vehicle = values[:, POSITION : POSITION + 9].reshape(-1, 3, 3)
    motion = np.concatenate([vehicle, posture], axis=2)
    for k, name in enumerate(names):
        yield _largest(f"rate of {name}", motion[:, 1, k], limits.rate[k], times)
        yield _largest(f"acceleration of {name}", motion[:, 2, k], limits.acceleration[k], times)
        yield from _bound(problem, name, k, motion[:, 0, k], times)
    yield _attitude(problem, "roll", values[:, ATTITUDE], limits.roll_max, times)
    yield _attitude(problem, "pitch", values[:, ATTITUDE + 1], limits.pitch_max, times)
    if problem.tool.oriented:
        turn = np.linalg.norm(values[:, TURN : TURN + 3], axis=1)
        yield _largest("the tool's orientation", turn, problem.turn_tolerance, times)
    for k in range(THRUST, values.shape[1]):
        yield _largest(f"thruster {k - THRUST + 1}", values[:, k], 1.0, times)


def _largest(name: str, values: Array, limit: float, times: Array) -> LimitShare:
    k = int(np.argmax(np.abs(values)))
    return LimitShare(
        name, float(abs(values[k]) / limit), float(times[k]), float(values[k]), float(limit)
    )


def _attitude(problem, name, values: Array, limit: float, times: Array) -> LimitShare:
    """Where the start is beyond the limit, what comes after the first return counts."""
    inside = np.flatnonzero(np.abs(values) <= limit)
    first = inside[0] if len(inside) else 0
    return _largest(f"free {name}", values[first:], limit, times[first:])


def _bound(problem: PathProblem, name: str, k: int, values: Array, times: Array):
    """Bounds of a variable as shares of their range; the start may be beyond them."""
    lower, upper = problem.limits.lower[k], problem.limits.upper[k]
    if k >= VEHICLE - 1:
        start = problem.start.value[k - VEHICLE + 1]
        lower, upper = min(lower, start), max(upper, start)
    half = (upper - lower) / 2 if np.isfinite(upper - lower) else 1.0
    if np.isfinite(upper):
        i = int(np.argmax(values))
        share = 1 + (values[i] - upper) / half
        yield LimitShare(f"greatest {name}", float(share), float(times[i]), values[i], upper)
    if np.isfinite(lower):
        i = int(np.argmin(values))
        share = 1 + (lower - values[i]) / half
        yield LimitShare(f"least {name}", float(share), float(times[i]), values[i], lower)
