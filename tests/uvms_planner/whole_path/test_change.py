"""What is left of a path after payload or thrusters have changed, planned anew on the way."""

from itertools import pairwise

import numpy as np
import pytest
from followed_path_rig import STEP_S, Followed, begun, dead, follow, payload, weak

from uvms_planner.planned_path import PlannedPath
from uvms_planner.whole_path import solve
from uvms_planner.whole_path.sample import THRUST

CASES = {
    "5 N in the gripper on a circle": ("reference", "circle", {15.0: payload(5.0)}),
    "a dead thruster on a line": ("reference", "line", {10.0: dead(2, 7)}),
    "1 N in the gripper of a small vehicle": ("bluerov2", "circle", {15.0: payload(1.0)}),
    "a dead thruster of a small vehicle": ("bluerov2", "circle", {15.0: dead(1, 6)}),
}
SETTLED_S = 0.5


@pytest.fixture(scope="module", params=CASES, ids=lambda name: name.replace(" ", "-"))
def followed(request) -> Followed:
    return follow(*CASES[request.param])


def test_the_motion_goes_to_the_new_optimum(followed):
    again = solve(followed.rest)
    assert followed.since_the_change().disturbance < 1.1 * again.report.disturbance


def test_every_limit_is_kept_at_every_millisecond(followed):
    worst = followed.since_the_change().worst
    assert worst.share < 1.001, worst


def test_steps_join_and_the_path_ends_at_rest(followed):
    for before, after in pairwise(followed.steps):
        for name in ("configuration", "rate", "acceleration"):
            end, begin = getattr(before, name)[-1], getattr(after, name)[0]
            np.testing.assert_allclose(begin, end, atol=1e-9)
    assert np.abs(followed.steps[-1].rate[-1]).max() < 1e-9


def test_limits_are_kept_however_often_the_payload_changes():
    """It swings by 4 N with every step for 10 s, as no estimate of one payload does."""
    weights = {15.0 + STEP_S * k: payload(3.0 + 2.0 * (-1) ** k) for k in range(20)}
    found = follow("reference", "circle", weights)
    solver, _, _, _ = begun("reference", "circle")
    limits = solver.motion_limits
    assert (np.abs(found.joined("rate")) <= 1.001 * limits.rate).all()
    assert (np.abs(found.joined("acceleration")) <= 1.001 * limits.acceleration).all()
    assert np.abs(found.steps[-1].rate[-1]).max() < 1e-9


def test_a_change_near_the_end_is_planned_to_the_end():
    found = follow("reference", "circle", {50.0: payload(5.0)})
    report, again = found.since_the_change(), solve(found.rest).report
    assert report.worst.share < 1.001, report.worst
    assert report.disturbance < 1.1 * again.disturbance


def test_the_same_changes_give_the_same_motion():
    changes = {5.0: payload(5.0), 7.0: dead(2, 7)}
    first, second = (follow("reference", "line", changes) for _ in range(2))
    for name in ("configuration", "rate", "acceleration"):
        np.testing.assert_array_equal(first.joined(name), second.joined(name))


def test_without_a_change_the_plan_is_followed_as_it_is():
    solver, joined, knot, plan = begun("reference", "circle")
    times = np.linspace(0.0, STEP_S, 11)
    step = PlannedPath(solver, joined, plan, 0, STEP_S).plan(knot, times)
    np.testing.assert_array_equal(step.samples.acceleration, plan.sample(times).acceleration)


@pytest.mark.parametrize("vehicle", ["reference", "bluerov2"])
def test_thrusters_that_have_less_than_the_plan_needs_are_planned_with(vehicle):
    """All have what is left of them by the same share, so that the plan would need 110 % of it."""
    solver, _, _, plan = begun(vehicle, "circle")
    count = len(solver.around.shares)
    shares = plan.values(plan.instants())[:, THRUST : THRUST + count]
    left = shares[plan.instants() > 5.0].max() / 1.1
    found = follow(vehicle, "circle", {5.0: weak(np.full(count, left))})
    # at the change itself the motion is as it is: its acceleration does not jump
    worst = found.since_the_change(SETTLED_S).worst
    assert worst.share < 1.001, worst
