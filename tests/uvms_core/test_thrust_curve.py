"""Thrust by command: its closed form, its inverse, what it refuses and with which words."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.thrust_curve import ThrustCurve
from uvms_core.vehicle.thrusters import Thruster

TABLE = {"command": (-1.0, -0.5, -0.1, 0.1, 0.5, 1.0), "thrust_n": (-40, -12, 0, 0, 16, 50)}
SQUARES = {"ahead_n": (0.5, 20.0, 30.0), "astern_n": (0.25, 15.0, 20.0)}


def thruster(**fields):
    place = {"name": "t", "position_m": (0, 0, 0), "direction": (1, 0, 0)}
    return Thruster(**place, time_constant_s=0.1, slew_limit_n_s=100.0, **fields)


def refusal(**fields):
    with pytest.raises(ValidationError) as fault:
        thruster(**fields)
    return str(fault.value)


def test_a_table_is_interpolated_and_has_no_thrust_where_it_is_flat():
    given_commands = np.array([-2.0, -1.0, -0.75, -0.3, -0.1, 0.0, 0.05, 0.3, 1.0, 1.5])
    thrust = thruster(curve=TABLE).thrust(given_commands)
    np.testing.assert_allclose(thrust, [-40, -40, -26, -6, 0, 0, 0, 8, 50, 50], atol=1e-12)


def test_a_dead_zone_cuts_a_table_off_and_leaves_a_least_thrust():
    part = thruster(curve=TABLE, dead_zone=0.2)
    assert part.least_n == pytest.approx((-3.0, 4.0))
    np.testing.assert_allclose(
        part.thrust(np.array([-0.2, -0.19, 0.19, 0.2, 0.3])), [-3, 0, 0, 4, 8]
    )


@given(command=st.floats(-1.0, 1.0))
def test_a_polynomial_counts_from_the_end_of_the_dead_zone(command):
    dead = 0.08
    s = (abs(command) - dead) / (1.0 - dead)
    a, b, c = SQUARES["ahead_n" if command > 0 else "astern_n"]
    expected = np.sign(command) * (a + b * s + c * s**2) if s >= 0.0 else 0.0
    found = thruster(curve=SQUARES, dead_zone=dead).thrust(command)
    assert found == pytest.approx(expected, abs=30.0 / (4 * 256**2))


PARTS = [
    thruster(limit_n=49.0),
    thruster(limits_n=(-30.0, 50.0), dead_zone=0.1),
    thruster(limits_n=(0.0, 50.0)),
    thruster(curve=TABLE),
    thruster(curve=TABLE, dead_zone=0.3, limit_n=30.0),
    thruster(curve=SQUARES, dead_zone=0.05),
    thruster(curve={"ahead_n": (1.0, 9.0)}, dead_zone=0.05),
    load_vehicle("bluerov2_alpha5").thrusters[0],
]


@pytest.mark.parametrize("part", PARTS)
@given(wanted=st.floats(-100.0, 100.0))
def test_the_inverse_gives_the_nearest_thrust_that_can_be_had(part, wanted):
    command = float(part.command(wanted))
    given_thrust = float(part.thrust(command))
    assert -1.0 <= command <= 1.0
    assert given_thrust == pytest.approx(float(part.reachable(wanted)), abs=1e-9)
    others = part.thrust(np.linspace(-1.0, 1.0, 401))
    assert abs(given_thrust - wanted) <= np.min(np.abs(others - wanted)) + 1e-9


@pytest.mark.parametrize("part", PARTS)
def test_thrust_never_falls_with_the_command(part):
    assert (np.diff(part.thrust(np.linspace(-1.0, 1.0, 1001))) >= 0.0).all()


def test_limits_follow_from_what_is_given():
    assert (PARTS[0].astern_n, PARTS[0].ahead_n, PARTS[0].is_ideal) == (-49.0, 49.0, True)
    assert (PARTS[1].astern_n, PARTS[1].ahead_n, PARTS[1].is_ideal) == (-30.0, 50.0, False)
    assert (PARTS[3].astern_n, PARTS[3].ahead_n) == (-40.0, 50.0)
    assert (PARTS[4].astern_n, PARTS[4].ahead_n) == (-30.0, 30.0)
    assert (PARTS[6].astern_n, PARTS[6].ahead_n, PARTS[6].greatest_n) == (0.0, 10.0, 10.0)


def test_bluerov2_has_the_t200s_published_ends_and_dead_zone():
    for part in load_vehicle("bluerov2_alpha5").thrusters:
        assert (part.astern_n, part.ahead_n) == pytest.approx((-39.9, 51.5))
        assert part.thrust(np.array([-0.069, 0.069])) == pytest.approx([0.0, 0.0])
        assert (part.thrust(np.array([-0.071, 0.071])) * [-1.0, 1.0] > 0.2).all()


def test_the_shape_is_that_of_the_published_table_at_10_v():
    """Blue Robotics' table, kgf by command; its dead zone is 10 % there."""
    command = np.array([0.2, 0.3, 0.5, 0.75, 1.0])
    ahead = np.array([0.18, 0.41, 0.97, 1.91, 2.93]) / 2.93
    astern = np.array([0.15, 0.34, 0.80, 1.54, 2.31]) / 2.31
    curve = load_vehicle("bluerov2_alpha5").thrusters[0].curve.table(0.1)
    np.testing.assert_allclose(curve.thrust(command) / 51.5, ahead, atol=0.025)
    np.testing.assert_allclose(-curve.thrust(-command) / 39.9, astern, atol=0.025)


def test_a_straight_line_is_what_there_is_without_a_curve():
    half = thruster(limits_n=(-30.0, 50.0)).thrust(np.array([-0.5, 0.5]))
    np.testing.assert_allclose(half, [-15.0, 25.0])


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({}, "needs limit_n, limits_n or a curve"),
        ({"limit_n": 1.0, "limits_n": (-1, 1)}, "limit_n and limits_n are the same thing"),
        ({"limits_n": (1, 2)}, "limits_n: 1 and 2 N; must be astern <= 0 < ahead"),
        ({"limit_n": 45.0, "curve": TABLE}, "its limits, -45 to 45 N, are beyond its curve, which"),
        ({"curve": SQUARES}, "gives 0.5 N or more as soon as there is a command"),
        ({"curve": {"command": (-1, 1)}}, "command has 2 values and thrust_n 0"),
        ({"curve": {**TABLE, **SQUARES}}, "either command and thrust_n, or ahead_n and astern_n"),
        (
            {"curve": {"command": (-1, 0, 0.5, 1), "thrust_n": (-9, 0, 5, 4)}},
            "thrust_n falls from 5 to 4 N where the command rises from 0.5 to 1",
        ),
        (
            {"curve": {"command": (-1, 0, 0.5, 1), "thrust_n": (-9, 0, 5, 5)}},
            "thrust_n stays at 5 N where the command rises from 0.5 to 1; only at 0 N",
        ),
        ({"curve": {"command": (-1, 1), "thrust_n": (-9, 10)}}, "is 0.5 N without a command"),
        ({"curve": {"command": (-1, 0.9), "thrust_n": (-9, 9)}}, "must rise from -1, or 0, to 1"),
        ({"curve": {"ahead_n": (0, 9, -8)}}, "ahead_n: the thrust does not rise with the command"),
        ({"curve": {"ahead_n": (-1, 9)}}, "the least thrust, is -1 N < 0"),
        ({"limit_n": 1.0, "dead_zone": 1.0}, "less than 1"),
    ],
)
def test_what_no_drive_does_is_refused(fields, words):
    assert words in refusal(**fields)


def test_a_refusal_names_the_thruster_of_the_file():
    curve = {"command": [-1, 0, 1], "thrust_n": [-40, 0, -1]}
    with pytest.raises(VehicleFileError, match=r"thrusters\.1.*thrust_n falls from 0 to -1 N"):
        load_vehicle(overrides={"thrusters.side_fore.curve": curve})


def test_a_curve_alone_is_a_curve():
    assert ThrustCurve(**TABLE).ends_n == (-40.0, 50.0)
    assert ThrustCurve(**SQUARES).ends_n == (-35.25, 50.5)
