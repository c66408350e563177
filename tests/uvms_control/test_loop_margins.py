"""Margins of a sampled axis against closed forms and against the loop itself, step by step."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.optimize import brentq

from uvms_control.design import Axis, AxisGains, loop_margins
from uvms_control.design.axis import _exponential, loop_matrices
from uvms_control.errors import ControlSetupError

FAST = 1e-3
"""s; a period at which the sampled loop is nearly the continuous one."""


def phase_and_gain(omega, gains, lag):
    """Open loop (P + D s) / (s^2 (T s + 1)) of a free hull at s = j omega."""
    s = 1j * omega
    return (gains.stiffness + gains.damping * s) / (s**2 * (lag * s + 1.0))


@pytest.mark.parametrize(("bandwidth", "ratio", "lag"), [(1.0, 0.7, 0.0), (2.0, 1.0, 0.1)])
def test_margins_of_a_fast_loop_are_those_of_the_continuous_one(bandwidth, ratio, lag):
    gains = AxisGains(bandwidth**2, 2.0 * ratio * bandwidth)
    crossover = brentq(lambda w: abs(phase_and_gain(w, gains, lag)) - 1.0, 0.1, 50.0)
    phase = np.pi + np.angle(phase_and_gain(crossover, gains, lag))
    found = loop_margins(Axis(inertia=7.0, lag=lag, period=FAST), gains)
    assert found.bandwidth == pytest.approx(crossover, rel=2e-3)
    # Half a period is the delay of the hold.
    assert found.phase_margin == pytest.approx(phase - 0.5 * FAST * crossover, abs=2e-3)


def test_delay_margin_is_phase_margin_by_crossover_frequency():
    gains = AxisGains(4.0, 3.0)
    axis = Axis(inertia=2.0, period=0.02)
    crossover = brentq(lambda w: abs(phase_and_gain(w, gains, 0.0)) - 1.0, 0.1, 50.0)
    delay = (np.pi + np.angle(phase_and_gain(crossover, gains, 0.0))) / crossover
    found = loop_margins(axis, gains)
    assert found.delay_margin == pytest.approx(delay - 0.5 * axis.period, rel=0.01)
    assert found.delay_margin == pytest.approx(found.phase_margin / found.bandwidth, rel=0.01)


def test_gain_margin_with_lag_follows_routh():
    """m x'' with lag: T s^3 + s^2 + g (D s + P) is stable for T P < D at any gain."""
    found = loop_margins(Axis(inertia=1.0, lag=0.1, period=1e-4), AxisGains(4.0, 3.0))
    assert found.gain_margin > 100.0  # the hold alone bounds it
    assert not loop_margins(Axis(inertia=1.0, lag=0.8, period=1e-4), AxisGains(4.0, 3.0)).stable
    just = loop_margins(Axis(inertia=1.0, lag=0.74, period=1e-4), AxisGains(4.0, 3.0))
    assert just.stable


def test_gain_margin_of_the_sampled_double_integrator():
    """A pure rate feedback on a mass, v+ = (1 - h D g) v, is stable for g < 2 / (h D)."""
    axis, gains = Axis(inertia=3.0, period=0.1), AxisGains(0.0, 4.0)
    poles = np.linalg.eigvals(loop_matrices(axis, gains).closed())
    assert np.min(np.abs(poles - (1.0 - 0.1 * 4.0))) < 1e-12
    # With the stiffness: z^2 - (2 - h D - h^2 P / 2) z + 1 - h D + h^2 P / 2, by Jury's test.
    gains = AxisGains(5.0, 4.0)
    found = loop_margins(axis, gains)
    assert found.gain_margin == pytest.approx(2.0 / (0.1 * gains.damping), rel=1e-5)


def test_poles_of_hull_and_feedback_together():
    """Fast loop: x'' + (D + d/m) x' + (P + c/m) x = 0, and the observer's pole apart from it."""
    axis = Axis(inertia=5.0, righting=28.0, drag=5.0, period=FAST)
    gains = AxisGains(3.0, 2.0, observer=0.7)
    found = loop_margins(axis, gains)
    expected = np.roots([1.0, 2.0 + 1.0, 3.0 + 5.6])
    near = [np.min(np.abs(found.poles - pole)) for pole in (*expected, -0.7)]
    assert np.max(near) < 0.01
    assert found.damping_ratio == pytest.approx(3.0 / 2.0 / np.sqrt(8.6), rel=0.01)


@pytest.mark.parametrize(("righting", "drag", "within"), [(0.0, 0.0, 1e-6), (10.0, 2.0, 1e-3)])
def test_observer_does_not_move_the_feedback_s_poles_while_the_model_is_right(
    righting, drag, within
):
    """Exactly on a free hull; righting and drag are means of both ends of an interval there."""
    axis = Axis(inertia=5.0, righting=righting, drag=drag, period=0.05, lag=0.12)
    without = loop_margins(axis, AxisGains(2.0, 2.0)).poles
    found = loop_margins(axis, AxisGains(2.0, 2.0, observer=0.8)).poles
    assert np.max([np.min(np.abs(found - pole)) for pole in (*without, -0.8)]) < within


def test_a_whole_lag_made_up_for_is_a_thrust_that_arrives_within_the_tick():
    axis = Axis(inertia=5.0, period=0.05, lag=0.1, lag_compensated=1.0)
    matrices = loop_matrices(axis, AxisGains(2.0, 2.0))
    state = np.zeros(len(matrices.A))
    state[1] = 1.0  # rate
    wanted = matrices.U @ state
    assert (matrices.closed() @ state)[2] == pytest.approx(wanted)
    slow, fast = (
        loop_margins(Axis(5.0, period=0.05, lag=0.1, lag_compensated=share), AxisGains(2.0, 2.0))
        for share in (0.0, 1.0)
    )
    assert fast.delay_margin > slow.delay_margin
    assert fast.damping_ratio > slow.damping_ratio


def run(axis, gains, delay, gain=1.0, noise=None, ticks=400):
    """The loop step by step, hull and thrust by scipy's exponential in small pieces; x and u."""
    m, h = axis.inertia, axis.period
    rates = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-axis.righting / m, -axis.drag / m, 1.0 / m, 0.0],
            [0.0, 0.0, -1.0 / axis.lag, 1.0 / axis.lag],
            [0.0, 0.0, 0.0, 0.0],
        ]
    )
    pieces = 20
    step = expm(rates * h / pieces)
    late = round(delay / h * pieces)
    sent = [0.0] * (late + pieces)
    state = np.array([1.0, 0.0, 0.0])
    a = np.exp(-h / axis.lag)
    w = model = mean = 0.0
    before = None
    places, thrusts = [], []
    for k in range(ticks):
        x, v = state[:2] + (0.0 if noise is None else noise[k])
        if before is not None:
            hull = 0.5 * axis.righting * (x + before[0]) + 0.5 * axis.drag * (v + before[1])
            missing = m * (v - before[1]) / h + hull - mean
            w += (1.0 - np.exp(-gains.observer * h)) * (missing - w)
        u = -m * (gains.stiffness * x + gains.damping * v) - w
        mean = u + (model - u) * (1.0 - a) * axis.lag / h
        model = a * model + (1.0 - a) * u
        before = x, v
        sent += [gain * u] * pieces
        for piece in range(pieces):
            command = sent[len(sent) - pieces + piece - late]
            state = (step @ np.append(state, command))[:3]
        places.append(x)
        thrusts.append(u)
    return np.array(places), np.array(thrusts)


AXIS = Axis(inertia=5.0, righting=12.0, drag=3.0, period=0.05, lag=0.12)
GAINS = AxisGains(6.0, 4.5, observer=0.8)


def grows(places):
    return np.abs(places[-60:]).max() > np.abs(places[-200:-140]).max()


@pytest.mark.parametrize("what", ["delay", "gain"])
def test_the_loop_itself_turns_unstable_at_its_margins(what):
    found = loop_margins(AXIS, GAINS)
    margin = getattr(found, f"{what}_margin")
    if what == "delay":
        below, above = (run(AXIS, GAINS, share * margin)[0] for share in (0.9, 1.15))
    else:
        shares = (1.0 + 0.9 * (margin - 1.0), 1.15 * margin)
        below, above = (run(AXIS, GAINS, 0.0, gain)[0] for gain in shares)
    assert not grows(below)
    assert grows(above)


def test_thrust_that_noise_causes_is_that_of_the_loop_itself():
    rng = np.random.default_rng(3)
    axis = Axis(5.0, 12.0, 3.0, 0.05, 0.12, authority=10.0, position_noise=0.01, rate_noise=0.02)
    noise = rng.normal(size=(40_000, 2)) * [0.01, 0.02]
    _, thrust = run(axis, GAINS, 0.0, noise=noise, ticks=len(noise))
    found = loop_margins(axis, GAINS)
    assert found.noise_rms == pytest.approx(np.std(thrust[500:]), rel=0.02)
    assert found.noise_share == pytest.approx(found.noise_rms / 10.0)


def test_noise_of_a_mass_with_rate_feedback_in_closed_form():
    """v+ = (1 - hD) v - hD n: var v = hD / (2 - hD) r^2, and u = -m D (v + n)."""
    axis = Axis(inertia=3.0, period=0.1, rate_noise=0.2, authority=5.0)
    gains = AxisGains(1e-4, 2.0)
    share = 0.1 * 2.0
    expected = 3.0 * 2.0 * 0.2 * np.sqrt(1.0 + share / (2.0 - share))
    assert loop_margins(axis, gains).noise_rms == pytest.approx(expected, rel=1e-3)


@given(st.lists(st.floats(-30.0, 30.0), min_size=9, max_size=9))
@settings(max_examples=100, deadline=None)
def test_matrix_exponential(entries):
    matrix = np.array(entries).reshape(3, 3)
    expected = expm(matrix)
    assert np.allclose(
        _exponential(matrix), expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max()
    )


def test_an_unstable_loop_has_no_margins():
    found = loop_margins(Axis(1.0, period=0.5), AxisGains(50.0, 1.0))
    assert not found.stable
    assert (found.delay_margin, found.gain_margin, found.phase_margin) == (0.0, 1.0, 0.0)
    assert found.noise_share == np.inf


def test_a_free_hull_without_feedback_has_all_margins_and_no_bandwidth():
    found = loop_margins(Axis(5.0, 12.0, 3.0), AxisGains(0.0, 0.0))
    assert found.stable
    assert found.bandwidth == 0.0
    assert (found.delay_margin, found.gain_margin) == (np.inf, np.inf)
    assert found.damping_ratio == pytest.approx(0.6 / 2.0 / np.sqrt(2.4), rel=1e-6)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inertia": 0.0}, "axis loop inertia: 0, expected above 0"),
        ({"lag": -0.1}, "axis loop lag: -0.1, expected 0 or more"),
        ({"lag_compensated": 1.5}, "axis loop lag_compensated: 1.5, expected from 0 to 1"),
        ({"righting": np.nan}, "axis loop righting: nan, expected finite"),
    ],
)
def test_an_axis_that_cannot_be_is_refused(change, message):
    with pytest.raises(ControlSetupError) as error:
        Axis(**({"inertia": 1.0} | change))
    assert str(error.value) == message
