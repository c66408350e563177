"""A vehicle that floats beyond its limits at the start comes back, and does not go out again."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline
from whole_path_rig import bluerov2, problem_of, start_of

from uvms_planner.constraints import free_attitude
from uvms_planner.problem import VEHICLE
from uvms_planner.solver import MORE_TILT
from uvms_planner.whole_path import PathPlan, solve
from uvms_planner.whole_path.coming_level import level_once_back, stays_level
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.pieces import coarse_breaks
from uvms_planner.whole_path.sample import NO_SURROUNDINGS
from uvms_planner.whole_path.spline import DEGREE, greville

OWN = np.radians(5.0), np.radians(4.0)
LEVEL_DEG = [36.0, 143.0, 138.0, 0.0]
"""A posture in which the BlueROV2 floats level within half a degree."""
LINE = {"line": {"to_m": [0.2, 0.0, 0.1], "duration_s": 120}}


@pytest.fixture(scope="module")
def problem() -> PathProblem:
    """From `home`, in which the hull pitches by 6.5 deg, with limits to match."""
    found = problem_of(LINE, bluerov2())
    pitch = abs(free_attitude(found.model, start_of(bluerov2())[VEHICLE:].copy())[1])
    assert pitch > OWN[1]
    limits = replace(found.limits, pitch_max=MORE_TILT * pitch)
    return replace(found, limits=limits, around=NO_SURROUNDINGS)


def going(problem: PathProblem, *shares: float) -> PathPlan:
    """A plan from the start's posture through shares of the way to the level one, evenly timed."""
    there = np.concatenate([[0.0], np.radians(LEVEL_DEG)])
    discrete = discretise(problem, coarse_breaks(problem))
    through = np.interp(
        greville(discrete.knots), np.linspace(0.0, problem.duration, len(shares)), shares
    )
    smooth = (through**2 * (3 - 2 * through))[:, None]
    values = problem.start.value + smooth * (there - problem.start.value)
    sites = greville(discrete.knots)
    spline = make_interp_spline(sites, values, k=DEGREE, t=discrete.knots)
    return PathPlan(problem, discrete.knots, discrete.complete(spline.c), 0)


def test_what_comes_back_once_stays_level(problem):
    assert stays_level(going(problem, 0.0, 1.0, 1.0), OWN)
    assert not stays_level(going(problem, 0.0, 1.0, 0.0), OWN)
    assert stays_level(going(problem, 0.0, 0.0), OWN)  # never within, so never out again


def test_a_plan_that_leaves_again_is_planned_within_the_own_limits(problem):
    asked = []

    def method(wanted, progress):
        asked.append(wanted.limits.pitch_max)
        return going(wanted, 0.0, 1.0, 0.0) if wanted is problem else solve(wanted)

    found = level_once_back(problem, OWN, method, lambda share, text: None)
    assert asked == [problem.limits.pitch_max, OWN[1]]
    assert found.report.feasible
    assert stays_level(found, OWN)


def test_a_plan_that_comes_back_and_stays_is_taken_as_it_is(problem):
    plan = going(problem, 0.0, 1.0, 1.0)
    assert plan.report.feasible

    def method(wanted, progress):
        assert wanted is problem
        return plan

    assert level_once_back(problem, OWN, method, lambda share, text: None) is plan
