"""What is left of a path planned anew after the model has changed, while it is followed.

The motion in hand always goes on to the path's end and rests there: a window up to its end, and
from there a plan of the whole path. At every step the next seconds are planned with the model as it
is now, tied to the plan that the motion in hand ends with, and beside it the rest of the path, a
little with every step. As soon as the rest is planned, windows are tied to the new plan; the first
of them that keeps the limits leads over to it, and the change is over. A window, or a plan, is
taken only if it keeps every limit up to its end; where none does, the motion in hand goes on, which
has been found to keep them. So whatever comes of a step, there is a next one (recursive
feasibility), and position, rate and acceleration are continuous at every seam.
"""

from dataclasses import replace

from uvms_planner.whole_path.path_problem import PathProblem, Posture
from uvms_planner.whole_path.replan import Replanning
from uvms_planner.whole_path.window import SHORTEST_S, PathWindow, TimedPlan, acceptable


class Change:
    """Leads from the motion in hand to the best plan of what is left of the path.

    Args:
        problem: of the whole path, with model, limits and surroundings as they are now.
        begin: s of the path, from which on it is planned anew.
        in_hand: the motion so far.
    """

    def __init__(self, problem: PathProblem, begin: float, in_hand: TimedPlan) -> None:
        self._problem = problem
        self._window = PathWindow(problem)
        self._last: TimedPlan | None = None
        self._rest: Replanning | None = None
        self._from = begin
        self._planned: TimedPlan | None = None
        self.over = False
        left = problem.duration - begin
        if left > self._window.duration:
            rest = replace(
                problem, tool=problem.tool.after(begin), duration=left, start=in_hand.state(begin)
            )
            self._rest = Replanning(rest, lambda times: in_hand.posture(begin + times))

    def step(self, begin: float, start: Posture, in_hand: TimedPlan) -> TimedPlan:
        """The motion from `begin` s of the path on, where it is as `start`."""
        self._go_on_with_the_rest(begin, in_hand)
        left = self._problem.duration - begin
        if left < SHORTEST_S:
            self.over = True
            return in_hand
        if left <= self._window.duration:
            return self._to_the_end(begin, start, in_hand, left)
        then = self._planned or _whole(in_hand)
        found = self._window.solve(begin, start, self._last, then, in_hand)
        if not acceptable(found, in_hand, begin):
            self._last = None
            return in_hand
        self._last = found
        self.over = self._planned is not None and self._rest is None
        return found

    def _to_the_end(
        self, begin: float, start: Posture, in_hand: TimedPlan, left: float
    ) -> TimedPlan:
        """A window that ends with the path, at rest: nothing is left to be planned after it."""
        found = self._window.solve(begin, start, known=in_hand, duration=left)
        if not acceptable(found, in_hand, begin):
            return in_hand
        self.over = True
        return found

    def _go_on_with_the_rest(self, begin: float, in_hand: TimedPlan) -> None:
        rest = self._rest
        if rest is None:
            return
        before = rest.plan
        rest.advance()
        if rest.plan is not None and rest.plan is not before:
            planned = TimedPlan(self._from, rest.plan, feasible=rest.plan.report.feasible)
            if acceptable(planned, in_hand, begin):
                self._planned, self._last = planned, None
        if rest.over:
            self._rest = None


def _whole(plan: TimedPlan) -> TimedPlan:
    """The plan that a motion ends with."""
    return plan if plan.then is None else _whole(plan.then)
