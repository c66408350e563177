"""What a plan costs, and how much of each limit it takes."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.sample import ATTITUDE, MANIPULABILITY, TURN, WRENCHES
from uvms_planner.whole_path.sampled_bounds import sampled_bounds, value_names

FORGIVEN = 1e-3  # share by which a limit may be exceeded; mm and mrad of a position


@dataclass(frozen=True)
class LimitShare:
    """Where a plan comes nearest to one limit."""

    name: str  # such as "rate of joint 2"
    share: float  # 1 at the limit; of a position's bound 1 + what it is exceeded by, m or rad
    time: float  # s after the beginning
    value: float  # SI and rad
    limit: float
    unit: str  # of value and limit

    def __str__(self) -> str:
        factor = np.rad2deg(1.0) if self.unit.startswith("rad") else 1.0
        unit = f" {self.unit.replace('rad', 'deg')}" if self.unit else ""
        value, limit = (f"{factor * number:.4g}{unit}" for number in (self.value, self.limit))
        return f"{self.name}: {value} at t = {self.time:.4g} s, allowed {limit}"


@dataclass(frozen=True)
class PlanReport:
    """Cost and limits of a plan."""

    disturbance: float  # J, integral of the squared restoring and coupling wrench
    force_rms: float  # N, of their sum
    moment_rms: float  # N m
    manipulability: float  # the arm's least, as a share of its best; 0 in a singular posture
    mean_manipulability: float  # over the path, likewise
    limits: tuple[LimitShare, ...]  # the worst first
    excess: Array  # (v,) shares by which the sampled values exceed their limits, or negative

    @property
    def worst(self) -> LimitShare:
        """The limit that the plan comes nearest to, or exceeds most."""
        return self.limits[0]

    @property
    def feasible(self) -> bool:
        """Whether every limit is kept."""
        return self.worst.share <= 1 + FORGIVEN


def report_of(problem: PathProblem, times: Array, posture: Array, values: Array) -> PlanReport:
    """The report of posture (k, 3, d) and values (k, v) of `sample` at `times` (k,) s."""
    wrenches = values[:, :WRENCHES]
    total = wrenches[:, :6] + wrenches[:, 6:]
    manipulability = _share(values[:, MANIPULABILITY], problem.best_manipulability)
    sampled = list(_of_samples(problem, values, times))
    limits = [*(worst for worst, _ in sampled if worst), *_of_posture(problem, posture, times)]
    return PlanReport(
        float(np.trapezoid(np.sum(wrenches**2, axis=1), times)),
        _rms(total[:, :3], times),
        _rms(total[:, 3:], times),
        float(manipulability.min()),
        float(np.trapezoid(manipulability, times) / (times[-1] - times[0])),
        tuple(sorted(limits, key=lambda limit: -limit.share)),
        np.array([excess for _, excess in sampled]),
    )


def _share(values: Array, best: float) -> Array:
    """The values over the best; 0 for an arm that has none anywhere."""
    return values / best if best > 0.0 else np.zeros_like(values)


def _rms(vectors: Array, times: Array) -> float:
    mean = np.trapezoid(np.sum(vectors**2, axis=1), times) / (times[-1] - times[0])
    return float(np.sqrt(mean))


def _of_samples(problem: PathProblem, values: Array, times: Array):
    """Of each sampled value what it comes to of its limit, and by how much it exceeds it."""
    bounds, names = sampled_bounds(problem), value_names(problem)
    turn = TURN - WRENCHES
    for j, (name, unit) in enumerate(names):
        here, when, scale = values[:, WRENCHES + j], times, bounds.scale[j]
        if ATTITUDE <= WRENCHES + j < TURN:
            here, when = _since_level(here, times, bounds.upper[j])
        if j == turn and problem.tool.oriented:
            angle = np.linalg.norm(values[:, TURN:MANIPULABILITY], axis=1)
            top = problem.turn_tolerance
            yield _nearest(name, unit, angle, when, -np.inf, top, None), -np.inf
            continue
        limit = _nearest(name, unit, here, when, bounds.lower[j], bounds.upper[j], scale)
        yield limit, -np.inf if limit is None else limit.share - 1


def _since_level(values: Array, times: Array, limit: float) -> tuple[Array, Array]:
    """Where the start is beyond the limit, what comes after the first return counts."""
    inside = np.flatnonzero(np.abs(values) <= limit)
    first = inside[0] if len(inside) else 0
    return values[first:], times[first:]


def _of_posture(problem: PathProblem, posture: Array, times: Array):
    """Yaw and joints, their rates and accelerations."""
    limits = problem.limits
    names = ["yaw", *(f"joint {i + 1}" for i in range(problem.size - 1))]
    for k, name in enumerate(names):
        c, start = VEHICLE - 1 + k, problem.start.value[k]
        low, high = min(limits.lower[c], start), max(limits.upper[c], start)
        for what, unit, row, lower, upper, scale in (
            ("", "rad", 0, low, high, 1.0),
            ("rate of ", "rad/s", 1, -limits.rate[c], limits.rate[c], limits.rate[c]),
            (
                "acceleration of ", "rad/s^2", 2,
                -limits.acceleration[c], limits.acceleration[c], None,
            ),
        ):  # fmt: skip
            found = _nearest(what + name, unit, posture[:, row, k], times, lower, upper, scale)
            if found is not None:
                yield found


def _nearest(
    name: str,
    unit: str,
    values: Array,
    times: Array,
    lower: float,
    upper: float,
    scale: float | None,
) -> LimitShare | None:
    """Where values (k,) are nearest to a bound, or farthest beyond it; None without bounds."""
    scale = upper if scale is None else scale
    over, under = int(np.argmax(values)), int(np.argmin(values))
    found = [
        LimitShare(
            name, float(1 + gap / scale), float(times[i]), float(values[i]), float(bound), unit
        )
        for i, bound, gap in (
            (over, upper, values[over] - upper),
            (under, lower, lower - values[under]),
        )
        if np.isfinite(bound)
    ]
    return max(found, key=lambda limit: limit.share) if found else None
