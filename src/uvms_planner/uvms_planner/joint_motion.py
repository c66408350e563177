"""Rest-to-rest motion of the joints between the points of a goal, while the vehicle holds."""

import numpy as np

from uvms_core.signals import Array, JointGoal
from uvms_planner.errors import GoalRejected
from uvms_planner.limits import JointLimits
from uvms_planner.problem import VEHICLE
from uvms_planner.segment import Samples, evaluate, quintic
from uvms_planner.timed_motion import TimedMotion

PEAK_RATE = 1.875  # of a rest-to-rest quintic, times distance / duration
PEAK_ACCELERATION = 10 / np.sqrt(3)  # times distance / duration^2


class JointTrajectory(TimedMotion):
    """Quintic rest-to-rest pieces from the joints of `configuration` (m,) through the goal."""

    def __init__(self, goal: JointGoal, configuration: Array, start: int, step: float):
        super().__init__(start, step)
        self._times = np.concatenate([[0.0], goal.times])
        self._points = np.tile(configuration, (len(self._times), 1))
        self._points[1:, VEHICLE:] = goal.positions
        still = np.zeros_like(configuration)
        self._pieces = [
            quintic((first, still, still), (last, still, still), duration)
            for first, last, duration in zip(
                self._points[:-1], self._points[1:], np.diff(self._times), strict=True
            )
        ]

    @property
    def duration(self) -> float:
        """Seconds that the motion takes."""
        return float(self._times[-1])

    def sample(self, times: Array) -> Samples:
        """Configuration, rate and acceleration (k, m) at `times` (k,) s after the start."""
        inside = np.clip(times, 0.0, self.duration)
        piece = np.clip(
            np.searchsorted(self._times, inside, side="right") - 1, 0, len(self._pieces) - 1
        )
        rows = [
            evaluate(self._pieces[i], np.array([time - self._times[i]]))
            for i, time in zip(piece, inside, strict=True)
        ]
        return Samples(
            np.vstack([row.configuration for row in rows]),
            np.vstack([row.rate for row in rows]),
            np.vstack([row.acceleration for row in rows]),
        )


def check_joint_goal(goal: JointGoal, q: Array, limits: JointLimits) -> None:
    """Raise GoalRejected if the goal, from the joints `q` (n,), is malformed or beyond a limit."""
    times, positions = np.asarray(goal.times), np.asarray(goal.positions)
    count = len(limits.names)
    if times.ndim != 1 or len(times) < 1 or positions.shape != (len(times), count):
        raise GoalRejected(
            f"joint goal: times has shape {times.shape} and positions {positions.shape};"
            f" needed are (k,) and (k, {count}) with k >= 1"
        )
    if not (np.all(np.isfinite(times)) and np.all(np.isfinite(positions))):
        raise GoalRejected("joint goal: every time and position must be finite")
    if times[0] <= 0.0 or np.any(np.diff(times) <= 0.0):
        raise GoalRejected("joint goal: times must be > 0 and increasing")
    starts = np.vstack([q, positions[:-1]])
    for index, (first, last) in enumerate(zip(starts, positions, strict=True)):
        duration = times[index] - (times[index - 1] if index else 0.0)
        _check_piece(index, first, last, float(duration), limits)


def _check_piece(index: int, first: Array, last: Array, duration: float, limits: JointLimits):
    rate = PEAK_RATE * np.abs(last - first) / duration
    acceleration = PEAK_ACCELERATION * np.abs(last - first) / duration**2
    for i, name in enumerate(limits.names):
        where = f"joint goal: point {index}: joint {name}"
        if not limits.lower[i] <= last[i] <= limits.upper[i]:
            raise GoalRejected(
                f"{where}: {_deg(last[i])} deg is outside {_deg(limits.lower[i])} to"
                f" {_deg(limits.upper[i])} deg"
            )
        if rate[i] > limits.rate[i]:
            raise GoalRejected(
                f"{where}: needs {_deg(rate[i])} deg/s, limit {_deg(limits.rate[i])} deg/s;"
                f" allow more than {duration:.4g} s"
            )
        if acceleration[i] > limits.acceleration[i]:
            raise GoalRejected(
                f"{where}: needs {_deg(acceleration[i])} deg/s^2, limit"
                f" {_deg(limits.acceleration[i])} deg/s^2; allow more than {duration:.4g} s"
            )


def _deg(angle: float) -> str:
    return f"{np.rad2deg(angle):.4g}"
