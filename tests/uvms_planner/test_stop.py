"""Coming to rest: within the limits from any state, and clear of what stands around."""

import numpy as np
import pytest
from planner_rig import START, solver_of

from uvms_core.scene import Obstacle
from uvms_core.signals import to_nanoseconds
from uvms_dynamics.geometry import clearances_along
from uvms_planner.safe_stop import LedStop, harm, safe_stop
from uvms_planner.segment import Knot, Samples
from uvms_planner.stop import Stop

STEP = 0.5
TIMES = np.linspace(0.0, STEP, 51)
STILL = np.zeros_like(START)


def followed(stop, knot: Knot) -> Samples:
    """All samples until rest and one step after."""
    parts, rest = [], stop.rest
    while knot.stamp <= rest:
        knot, samples = stop.plan(knot, TIMES)
        parts.append(samples)
    names = ("configuration", "rate", "acceleration")
    return Samples(*(np.vstack([getattr(part, name) for part in parts]) for name in names))


@pytest.mark.parametrize("seed", range(20))
def test_from_any_rate_and_acceleration_it_brakes_within_the_acceleration(seed):
    solver, rng = solver_of(), np.random.default_rng(seed)
    limits = solver.motion_limits
    rate = rng.uniform(-1.0, 1.0, len(START)) * limits.rate
    acceleration = rng.choice([-1.0, -0.5, 0.0, 1.0], len(START)) * limits.acceleration
    knot = Knot(0, START, rate, acceleration, STILL)
    stop = Stop(solver, knot, STEP)
    motion = followed(stop, knot)
    assert np.all(np.abs(motion.acceleration) <= limits.acceleration * (1 + 1e-6))
    np.testing.assert_allclose(motion.rate[0], rate, atol=1e-12)
    np.testing.assert_allclose(motion.acceleration[0], acceleration, atol=1e-12)
    np.testing.assert_allclose(motion.rate[-1], 0.0, atol=1e-12)
    np.testing.assert_allclose(motion.acceleration[-1], 0.0, atol=1e-12)
    np.testing.assert_allclose(motion.configuration[-1], stop.end(0).configuration, atol=1e-12)
    # the least time in which it could: from v against a, with the acceleration at once
    least = np.max(np.abs(rate) / limits.acceleration)
    assert least <= (stop.rest - knot.stamp) / 1e9 <= 2.2 * least + 2 * STEP


def test_what_is_faster_than_its_limit_already_brakes_no_harder_than_it_did():
    solver = solver_of()
    acceleration = STILL.copy()
    acceleration[4] = -3.0 * solver.motion_limits.acceleration[4]
    rate = STILL.copy()
    rate[4] = 0.5
    knot = Knot(0, START, rate, acceleration, STILL)
    motion = followed(Stop(solver, knot, STEP), knot)
    assert np.abs(motion.acceleration[:, 4]).max() <= -acceleration[4] * (1 + 1e-6)


RADIUS, SPEED = 1.15, 0.15
SPARE_M = 0.002
"""By which the circle keeps farther from the wall than it must."""


def wall(near: float) -> Obstacle:
    """A wall whose side at y = `near` m faces the circle."""
    box = {"center_m": [0.0, near + 0.1, 10.0], "size_m": [8.0, 0.2, 4.0]}
    return Obstacle.model_validate({"name": "wall", "box": box})


def beside_the_circle(**changes):
    """The solver with a wall as near to the circle as its margin allows, and `SPARE_M`."""
    solver = solver_of(obstacles=(wall(4.0),), **changes)
    on_circle = circle_samples(np.linspace(0.0, 2 * np.pi, 721)).configuration
    room = clearances_along(solver.geometry, on_circle) - solver.around.margins
    around = [k for k, pair in enumerate(solver.geometry.pairs) if pair.kind == "obstacle"]
    nearer = float(room[:, around].min()) - SPARE_M
    return solver_of(obstacles=(wall(4.0 - nearer),), **changes)


LIMITS = {"translation_rate_m_s": 0.2, "translation_acceleration_m_s2": 0.02}


def round_and_round(time: float) -> Knot:
    """The vehicle on a horizontal circle about (0, 0), past the wall."""
    angle = np.array([SPEED / RADIUS * time - np.pi / 2])
    samples = circle_samples(angle)
    row = [part[0] for part in (samples.configuration, samples.rate, samples.acceleration)]
    return Knot(to_nanoseconds(time), *row, STILL)


def circle_samples(angle: np.ndarray) -> Samples:
    c, v, a = (np.tile(each, (len(angle), 1)) for each in (START, STILL, STILL))
    cos, sin, turning = np.cos(angle), np.sin(angle), SPEED / RADIUS
    c[:, :2] = RADIUS * np.column_stack([cos, sin])
    v[:, :2] = RADIUS * turning * np.column_stack([-sin, cos])
    a[:, :2] = -RADIUS * turning**2 * np.column_stack([cos, sin])
    return Samples(c, v, a)


def follow(knot: Knot) -> tuple[Knot, Samples]:
    time = knot.stamp / 1e9
    angle = SPEED / RADIUS * (time + TIMES) - np.pi / 2
    return round_and_round(time + STEP), circle_samples(angle)


def test_it_follows_a_curve_round_what_it_would_run_into_before_it_stops():
    solver = beside_the_circle(limits=LIMITS)
    led = 0
    for time in np.arange(15.0, 26.0, 0.5):
        knot = round_and_round(float(time))
        at_once = Stop(solver, knot, STEP)
        stop = safe_stop(at_once, knot, follow, to_nanoseconds(1e3), solver, TIMES)
        dangerous = harm(at_once, knot, solver, TIMES) > 1e-3
        assert isinstance(stop, LedStop) == dangerous
        led += dangerous
        motion = followed(stop, knot)
        clear = clearances_along(solver.geometry, motion.configuration)
        assert np.all(clear >= np.minimum(solver.around.margins, clear[0]) - 1e-3)
        assert np.all(np.abs(motion.acceleration) <= solver.motion_limits.acceleration * 1.001)
        dt = TIMES[1]
        joined = np.diff(motion.rate, axis=0)
        assert np.abs(joined).max() <= 0.0201 * dt  # nothing jumps
    assert 3 < led < 22


def test_where_every_stop_does_harm_the_least_harmful_is_taken():
    solver = solver_of(limits=LIMITS, clearance={"obstacle_m": 5.0}, obstacles=(wall(4.0),))
    knot = round_and_round(2.0)
    at_once = Stop(solver, knot, STEP)
    stop = safe_stop(at_once, knot, follow, to_nanoseconds(3.0), solver, TIMES)
    assert stop.rest <= to_nanoseconds(30.0)
    assert followed(stop, knot).rate[-1] == pytest.approx(0.0, abs=1e-12)
