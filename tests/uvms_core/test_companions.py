"""Inputs that a writer of somebody else's may leave out."""

import pytest

from uvms_core.tick_gate import Companion, CompanionBefore, Same, TickGate

PERIOD = 50


@pytest.mark.parametrize("rule", [Companion, lambda: CompanionBefore(PERIOD)])
def test_nobody_waits_for_what_never_comes(rule):
    gate = TickGate({"state": Same(), "more": rule()}, "state", lockstep=True)
    for stamp in range(0, 500, PERIOD):
        (tick,) = gate.push("state", stamp, "here")
        assert tick["more"] is None
    assert gate.required == ("state",)


def test_what_has_come_once_is_waited_for():
    gate = TickGate({"state": Same(), "more": Companion()}, "state", lockstep=True)
    gate.push("more", 0, "first")
    assert [tick["more"] for tick in gate.push("state", 0, "here")] == ["first"]
    assert gate.push("state", PERIOD, "here") == []
    assert [tick["more"] for tick in gate.push("more", PERIOD, "second")] == ["second"]


def test_that_of_the_tick_before_is_waited_for_once_it_has_come():
    gate = TickGate({"state": Same(), "more": CompanionBefore(PERIOD)}, "state", lockstep=True)
    gate.push("state", 0, "here")
    gate.push("more", 0, "first")
    assert [tick["more"] for tick in gate.push("state", PERIOD, "here")] == ["first"]
    assert gate.push("state", 2 * PERIOD, "here") == []
    assert [tick["more"] for tick in gate.push("more", PERIOD, "second")] == ["second"]


def test_after_a_reset_it_may_be_left_out_again():
    gate = TickGate({"state": Same(), "more": Companion()}, "state", lockstep=True)
    gate.push("more", 0, "first")
    gate.push("state", 0, "here")
    gate.reset()
    assert len(gate.push("state", 0, "here")) == 1
