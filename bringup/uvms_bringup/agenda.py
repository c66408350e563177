"""The goals of a run one after the other, and what became of each."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from uvms_core.signals import Goal, JointGoal, PathGoal, PoseGoal, to_seconds

Goals = Goal | Sequence[Goal] | None
"""What a run is asked for: nothing, one goal, or several in turn."""

KINDS: dict[type, str] = {PathGoal: "path", JointGoal: "joints", PoseGoal: "pose"}


def in_turn(goals: Goals) -> tuple[Goal, ...]:
    """The goals of a run as a tuple."""
    if goals is None:
        return ()
    return tuple(goals) if isinstance(goals, Sequence) else (goals,)


def path_of(goals: Goals) -> PathGoal | None:
    """The path among them, None where there is none or more than one."""
    paths = [goal for goal in in_turn(goals) if isinstance(goal, PathGoal)]
    return paths[0] if len(paths) == 1 else None


@dataclass
class GoalRecord:
    """One goal of a run, as `RunEnd.goals` has it."""

    kind: str
    state: str = "waiting"
    message: str = ""
    began_s: float | None = None
    ended_s: float | None = None


class Agenda:
    """Goals in turn: each begins when the one before it has succeeded."""

    def __init__(self, goals: Goals) -> None:
        self._goals = in_turn(goals)
        self._records = [GoalRecord(KINDS[type(goal)]) for goal in self._goals]
        self._index = 0
        self.active = False

    @property
    def due(self) -> Goal | None:
        """The goal that is to begin now, if any."""
        if self.active or self._index >= len(self._goals):
            return None
        return self._goals[self._index]

    @property
    def begun(self) -> int:
        """How many goals have begun."""
        return sum(record.began_s is not None for record in self._records)

    @property
    def remaining(self) -> int:
        """How many goals are still to begin."""
        return max(len(self._goals) - self._index - self.active, 0)

    def begin(self, stamp: int) -> None:
        """The planner has accepted the goal that was due, at this stamp in ns."""
        record = self._records[self._index]
        record.state, record.began_s = "running", to_seconds(stamp)
        self.active = True

    def end(self, stamp: int, state: str, message: str = "") -> None:
        """The active goal has ended as `RunEnd.goal` says; a failure ends the agenda."""
        record = self._records[self._index]
        record.state, record.message, record.ended_s = state, message, to_seconds(stamp)
        self.active = False
        self._index = self._index + 1 if state == "succeeded" else len(self._goals)

    def refuse(self, stamp: int, message: str) -> None:
        """The planner has rejected the goal that was due."""
        self.end(stamp, "rejected", message)

    @property
    def state(self) -> str:
        """What became of all of them, in a word of `RunEnd.goal`."""
        states = [record.state for record in self._records]
        failed = [state for state in states if state not in ("waiting", "running", "succeeded")]
        if not states:
            return "none"
        if failed:
            return failed[0]
        return "succeeded" if set(states) == {"succeeded"} else "running"

    @property
    def phase(self) -> str:
        """What the goals are at, for who watches the run."""
        if not self._goals:
            return "no goal"
        ended = [record for record in self._records if record.ended_s is not None]
        if self.due is None and not self.active:
            last = ended[-1]
            return (
                "all goals succeeded"
                if self.state == "succeeded"
                else (f"{self._named(len(ended) - 1)} {last.state}: {last.message}")
            )
        return f"{self._named(self._index)} {'active' if self.active else 'being planned'}"

    def _named(self, index: int) -> str:
        return f"goal {index + 1} of {len(self._goals)} ({self._records[index].kind})"

    def records(self) -> tuple[dict[str, Any], ...]:
        """As plain data."""
        return tuple(asdict(record) for record in self._records)
