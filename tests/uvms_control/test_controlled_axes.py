"""Axes that the thrusters control, what the others get in passing, and thrusters that fail."""

import numpy as np
import pytest
from closed_loop import at_rest, hold
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from uvms_control import ControlConfig, Controller
from uvms_control.controlled_axes import AXES, axes_of, controlled_axes
from uvms_core.signals import Allocation, DisturbanceBudget, Wrench, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.locate import vehicle_path
from uvms_core.vehicle.postures import STOWED, posture_deg
from uvms_dynamics import thruster_matrix

REFERENCE = load_vehicle()
NAMES = [thruster.name for thruster in REFERENCE.thrusters]
KNOWN = np.array([3.0, -8.0, 5.0, 2.0, -4.0, 1.5])


def vehicle(name):
    return load_vehicle(vehicle_path(name))


def without(*dead):
    return np.array([0.0 if name in dead else 1.0 for name in NAMES])


def controlled(vehicle, effectiveness=None):
    found = axes_of(vehicle, effectiveness)
    return {name for name, flag in zip(AXES, found.is_controlled, strict=True) if flag}


@pytest.mark.parametrize(
    ("found", "lost"),
    [
        (controlled(REFERENCE), set()),
        (controlled(REFERENCE, without("main")), {"surge"}),
        (controlled(REFERENCE, without("side_fore")), {"sway"}),
        (controlled(REFERENCE, without("side_fore", "side_aft")), {"sway", "yaw"}),
        (controlled(REFERENCE, without("vertical_fore_port")), set()),
        (controlled(REFERENCE, without("vertical_fore_port", "vertical_aft_port")), {"roll"}),
        (controlled(vehicle("reference_auv_three_thrusters")), {"sway", "roll", "pitch"}),
        (controlled(vehicle("bluerov2_alpha5")), {"pitch"}),
    ],
    ids=["all", "main", "one lateral", "laterals", "one vertical", "port", "three", "BlueROV2"],
)
def test_the_axes_that_are_lost_are_those_of_the_layout(found, lost):
    """One lateral thruster gives yaw rather than sway: nothing else brings a heading back."""
    assert set(AXES) - found == lost


def test_axes_that_nothing_brings_back_are_taken_first():
    """One thruster that pushes along all axes at once controls heave; two, heave and yaw; ..."""
    order = ("heave", "yaw", "surge", "sway", "roll", "pitch")
    rng = np.random.default_rng(3)
    matrix, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    for m in range(1, 7):
        found = controlled_axes(matrix[:, :m], -np.ones(m), np.ones(m), np.zeros(m))
        taken = {name for name, flag in zip(AXES, found.is_controlled, strict=True) if flag}
        assert taken == set(order[:m])


@pytest.mark.parametrize(
    "dead",
    [
        ("vertical_fore_port", "vertical_aft_starboard"),
        ("vertical_fore_starboard", "vertical_aft_port"),
    ],
)
def test_of_roll_and_pitch_together_the_one_with_the_longer_lever_is_controlled(dead):
    """Of the verticals a diagonal is left: +-T at (0.55, 0.10) m, so that K / M = 0.10 / 0.55.

    Roll controlled instead would give 5.5 times as much pitch in passing, and capsize the hull.
    """
    found = axes_of(REFERENCE, without(*dead))
    assert controlled(REFERENCE, without(*dead)) == set(AXES) - {"roll"}
    assert abs(found.passing[3, 4]) == pytest.approx(0.10 / 0.55)


def test_dead_thrusters_control_nothing():
    """All of them told dead: the law asks for nothing, and goes on."""
    axes = axes_of(REFERENCE, np.zeros(len(NAMES)))
    assert not axes.is_controlled.any()
    assert not axes.passing.any()
    assert not axes.authority.any()


LAYOUTS = [
    (REFERENCE, None),
    (REFERENCE, without("main")),
    (REFERENCE, without("side_aft")),
    (REFERENCE, without("vertical_fore_port", "vertical_aft_starboard")),
    (vehicle("reference_auv_three_thrusters"), None),
    (vehicle("bluerov2_alpha5"), None),
]


def told(vehicle, effectiveness, stamp=0):
    none = np.zeros(6)
    thrust = np.zeros(vehicle.n_thrusters)
    share = np.ones(vehicle.n_thrusters) if effectiveness is None else effectiveness
    return Allocation(stamp, thrust, none, none, thrust > 0.0, share)


def commanded(vehicle, effectiveness, position, known=KNOWN):
    """Wrench (6,) off the reference, some seconds after the law was engaged."""
    stowed = np.radians(posture_deg(vehicle.arm, STOWED))
    controller = Controller(vehicle, ControlConfig(compensate_vehicle_motion=False))
    controller.prepare(0.05)
    none = DisturbanceBudget(0, np.zeros(6), np.zeros(6), known)
    controller.inform(none, told(vehicle, effectiveness))
    state = at_rest(stowed, position=position)
    for stamp in (0, to_nanoseconds(5.0)):
        odometry, joints = state.estimates(stamp)
        wrench, _ = controller.step(odometry, joints, Wrench(stamp, known), hold(stowed))
    return wrench.wrench


@pytest.mark.parametrize(
    ("layout", "effectiveness"), LAYOUTS,
    ids=["reference", "main dead", "lateral dead", "two verticals dead", "three", "BlueROV2"],
)  # fmt: skip
def test_the_wrench_is_one_that_the_thrusters_can_give(layout, effectiveness):
    """In the range of the thruster matrix, so that no allocation trades one axis for another."""
    position = (-0.05, 0.04, -0.03)
    wrench = commanded(layout, effectiveness, position)
    matrix = thruster_matrix(layout)
    if effectiveness is not None:
        matrix = matrix * effectiveness
    thrust, *_ = np.linalg.lstsq(matrix, wrench, rcond=None)
    assert np.linalg.norm(wrench) > 1.0
    assert np.allclose(matrix @ thrust, wrench, rtol=0, atol=1e-9 * np.abs(wrench).max())
    for axis in np.flatnonzero(~axes_of(layout, effectiveness).is_controlled):
        lost = np.array(KNOWN)
        lost[axis] += 7.0  # a load along an axis that is lost is not answered
        assert np.allclose(commanded(layout, effectiveness, position, lost), wrench, atol=1e-9)
        if axis < 3:
            moved = np.array(position)
            moved[axis] += 0.5  # nor is an error there
            assert np.allclose(commanded(layout, effectiveness, moved), wrench, atol=1e-9)


def test_what_the_thrusters_lose_and_regain_takes_effect_in_the_run():
    stowed = np.radians(posture_deg(REFERENCE.arm, STOWED))
    controller = Controller(REFERENCE, ControlConfig(compensate_vehicle_motion=False))
    controller.prepare(0.05)
    none = DisturbanceBudget(0, np.zeros(6), np.zeros(6), KNOWN)
    state, found = at_rest(stowed), []
    for k, share in enumerate([None, None, without("main"), without(), without("side_fore")]):
        stamp = k * to_nanoseconds(5.0)
        controller.inform(none, None if share is None else told(REFERENCE, share))
        odometry, joints = state.estimates(stamp)
        wrench, _ = controller.step(odometry, joints, Wrench(stamp, KNOWN), hold(stowed))
        found.append(wrench.wrench)
    assert np.allclose([found[1], found[3]], -KNOWN, atol=1e-12)
    assert np.allclose(found[2], np.where(np.arange(6) == 0, 0.0, -KNOWN), atol=1e-12)
    # The lateral thruster that is left gives yaw, and sway in passing: N / 0.75 m.
    assert found[4][5] == pytest.approx(-KNOWN[5], abs=1e-12)
    assert found[4][1] == pytest.approx(KNOWN[5] / 0.75, rel=1e-9)


entry = st.floats(-1.0, 1.0).map(lambda x: round(x, 3))


@st.composite
def layouts(draw):
    m = draw(st.integers(1, 8))
    columns = st.lists(entry, min_size=6, max_size=6).filter(lambda c: np.linalg.norm(c) > 0.1)
    matrix = np.array([draw(columns) for _ in range(m)]).T
    ahead = np.array([draw(st.floats(1.0, 100.0)) for _ in range(m)])
    astern = np.array([draw(st.floats(0.3, 1.0)) for _ in range(m)]) * ahead
    return matrix, -astern, ahead


@settings(deadline=None, max_examples=60)
@given(layout=layouts())
def test_passing_gives_the_controlled_axes_and_lies_in_reach(layout):
    matrix, lower, upper = layout
    found = controlled_axes(matrix, lower, upper, np.ones(upper.size))
    on, P = found.is_controlled, found.passing
    assert 1 <= on.sum() <= np.linalg.matrix_rank(matrix)
    assert np.array_equal(P[on], np.eye(6)[on])
    assert not P[:, ~on].any()
    assert np.allclose(P @ P, P, atol=1e-12)
    thrusts = np.linalg.lstsq(matrix, P, rcond=None)[0]
    assert np.allclose(matrix @ thrusts, P, atol=1e-7 * np.abs(P).max())
    assert np.array_equal(found.authority > 0.0, on)
    assert np.array_equal(found.lag, on.astype(float))


def best(matrix, lower, upper, controlled, axis, sign):
    """Greatest force along an axis, the other controlled ones at zero, those that are lost free."""
    others = controlled & (np.arange(6) != axis)
    done = linprog(
        -sign * matrix[axis],
        A_eq=matrix[others],
        b_eq=np.zeros(others.sum()),
        bounds=list(zip(lower, upper, strict=True)),
    )
    return -done.fun


@settings(deadline=None, max_examples=40)
@given(layout=layouts())
def test_authority_is_what_a_linear_programme_finds_at_least(layout):
    """A lower bound: of all thrusts it takes those of least norm, within the weaker direction."""
    matrix, lower, upper = layout
    found = controlled_axes(matrix, lower, upper, np.zeros(upper.size))
    for axis in np.flatnonzero(found.is_controlled):
        both = [best(matrix, lower, upper, found.is_controlled, axis, s) for s in (1.0, -1.0)]
        assert found.authority[axis] <= min(both) * (1 + 1e-6)


@settings(deadline=None, max_examples=40)
@given(layout=layouts())
def test_authority_is_the_linear_programme_s_where_no_thruster_is_too_many(layout):
    matrix, _, upper = layout
    found = controlled_axes(matrix, -upper, upper, np.zeros(upper.size))
    assume(found.is_controlled.sum() == upper.size)
    for axis in np.flatnonzero(found.is_controlled):
        exact = best(matrix, -upper, upper, found.is_controlled, axis, 1.0)
        assert found.authority[axis] == pytest.approx(exact, rel=1e-6)


def test_a_thruster_s_lag_is_that_of_the_axes_on_which_it_acts():
    lag = axes_of(load_vehicle(overrides={"thrusters.0.time_constant_s": 0.7})).lag
    assert NAMES[0] == "main"
    assert lag[0] == 0.7
    assert np.all(lag[1:] < 0.7)
