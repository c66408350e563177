"""Checks of signals: what is refused, in what words, and that it happens once."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from uvms_core import checks
from uvms_core.errors import SignalError
from uvms_core.signals import Array3, ByJoint, GpsSample, JointStates, Odometry, Wrench

NAN = float("nan")
NAMES = ("a", "b")


def odometry(**changes):
    level = np.array([0.0, 0.0, 0.0, 1.0])
    made = Odometry(0, np.zeros(3), level, np.zeros(6), np.eye(6), np.eye(6))
    return replace(made, **changes)


def joints(n=2):
    return JointStates(0, np.zeros(n), np.zeros(n), np.zeros(n))


@dataclass(frozen=True)
class Altitude:
    """A signal of somebody else's package."""

    stamp: int
    height: float
    beam: Array3
    gain: ByJoint
    comment: str = ""


ALTITUDE = Altitude(0, 3.0, np.zeros(3), np.zeros(2), "over sand")

BAD = [
    (odometry(nu=np.array([0, 0, NAN, 0, 0, 0.0])), "x.nu[2] is nan; it must be finite"),
    (odometry(nu=np.zeros(5)), "x.nu has shape (5,); it must have (6,)"),
    (odometry(nu=[0.0] * 6), "x.nu has type list; it must be an array of float64"),
    (odometry(nu=np.zeros(6, int)), "x.nu has type int64; it must be an array of float64"),
    (odometry(quaternion=np.zeros(4)), "x.quaternion has length 0; it must be 1"),
    (
        odometry(pose_covariance=np.diag([1.0, 1, np.inf, 1, 1, 1])),
        "x.pose_covariance[2, 2] is inf; it must be finite",
    ),
    (joints(3), "x.position has shape (3,); it must have (2,) for a, b"),
    (
        replace(joints(), effort=np.array([0.0, -np.inf])),
        "x.effort[b] is -inf; it must be finite",
    ),
    (GpsSample(0, True, NAN, 1.0, 1.0, np.eye(3)), "x.latitude_deg is nan; it must be finite"),
    (replace(ALTITUDE, height=NAN), "x.height is nan; it must be finite"),
    (replace(ALTITUDE, beam=np.zeros(2)), "x.beam has shape (2,); it must have (3,)"),
]


@pytest.mark.parametrize(("signal", "message"), BAD)
def test_a_bad_signal_is_refused_every_time(signal, message):
    for _ in range(2):
        with pytest.raises(SignalError) as fault:
            checks.check("x", signal, n=NAMES)
        assert str(fault.value) == message


@pytest.mark.parametrize(
    "signal", [odometry(), joints(), ALTITUDE, GpsSample(0, False, NAN, NAN, NAN, np.eye(3))]
)
def test_a_good_signal_passes(signal):
    checks.check("x", signal, n=NAMES)


def test_sizes_of_one_letter_agree_without_names():
    with pytest.raises(SignalError, match=r"x.velocity has shape \(2,\); it must have \(3,\)"):
        checks.check("x", replace(joints(3), velocity=np.zeros(2)))


def test_a_signal_is_checked_once_and_its_replacement_again():
    wrench = Wrench(0, np.zeros(6))
    checks.check("x", wrench)
    wrench.wrench[0] = NAN  # trusted from now on, as docs/signals.md states
    checks.check("x", wrench)
    with pytest.raises(SignalError):
        checks.check("x", replace(wrench, stamp=1))


def test_sizes_are_compared_with_each_vehicle():
    signal = checks.trust(joints(3))
    checks.check("x", signal, n=("a", "b", "c"))
    with pytest.raises(SignalError, match=r"must have \(2,\) for a, b"):
        checks.check("x", signal, n=NAMES)


def test_the_mark_does_not_make_signals_differ():
    one, other = Altitude(0, 1.0, *[None] * 2), Altitude(0, 1.0, *[None] * 2)
    checks.trust(one)
    assert one == other
    assert repr(one) == repr(other)


@pytest.mark.parametrize("off", [0.9e-3, -0.9e-3])
def test_quaternions_may_be_off_by_the_tolerance(off):
    checks.check("x", odometry(quaternion=(1.0 + off) * np.array([0.6, 0.0, 0.0, 0.8])))
    with pytest.raises(SignalError, match="it must be 1"):
        checks.check("x", odometry(quaternion=(1.0 + 1.2 * off) * np.array([0.6, 0.0, 0.0, 0.8])))


def test_stamps_increase_and_are_not_old():
    checks.later("x", 2, 1, "the last one's")
    with pytest.raises(SignalError, match="x is 1 ns; it must be after the last one's, 1 ns"):
        checks.later("x", 1, 1, "the last one's")
    checks.age("x", 0, 500_000_000)
    for stamp, now in ((0, 500_000_001), (1, 0)):
        with pytest.raises(SignalError, match="it must lie within"):
            checks.age("x", stamp, now)


DAMAGES = {
    "none": lambda x: x,
    "float32": lambda x: x.astype(np.float32),
    "list": lambda x: x.tolist(),
    "subclass": lambda x: x.view(np.matrix)[0],
    "shorter": lambda x: x[:-1],
    "empty": lambda x: x[:0],
    "a row": lambda x: x[None],
    "not a number": lambda x: np.full_like(x, np.nan),
    "infinite": lambda x: np.full_like(x, -np.inf),
    "squares overflow": lambda x: np.full_like(x, 1e200),
    "longer than a unit": lambda x: 2.0 * x,
}


@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize(
    ("make", "field"),
    [(joints, "position"), (joints, "effort"), (odometry, "quaternion"), (odometry, "nu")],
)
def test_the_quick_test_of_all_fields_refuses_what_that_of_each_field_refuses(make, field, damage):
    """With names every field is looked at by itself."""
    value = DAMAGES[damage](getattr(make(), field))
    verdicts = []
    for names in ({}, {"n": NAMES}):
        try:
            with np.errstate(over="ignore"):
                checks.check("signal", replace(make(), **{field: value}), **names)
            verdicts.append("good")
        except SignalError:
            verdicts.append("refused")
    assert verdicts[0] == verdicts[1]


def test_signals_in_a_row_are_marked_only_if_all_are_good():
    good, again, bad = joints(3), joints(3), joints(3)
    bad.position[1] = np.nan
    checks.trust_good([good, bad])
    with pytest.raises(SignalError, match=r"position\[1\] is nan"):
        checks.check("joint_states", bad)
    checks.trust_good([good, again])
    again.position[1] = np.nan
    checks.check("joint_states", again)  # has been checked
