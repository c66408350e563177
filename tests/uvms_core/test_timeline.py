"""The time that a node's inputs agree on: wrong stamps are left out, jumps of time are found."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from uvms_core.timeline import CONFIRMED, SILENCE_S, Item, Timeline

S = 1_000_000_000
DT = S // 20


class Run:
    """A node with two topics at 20 Hz, and what its timeline lets through."""

    def __init__(self, topics=("a", "b")):
        self.timeline, self.topics = Timeline(DT), topics
        self.wall, self.through, self.jumps = 0.0, [], []

    def say(self, name, stamp):
        self.wall += 0.01
        self._take(self.timeline.judge(Item(name, stamp, np.zeros(2)), self.wall))

    def silence(self, seconds):
        self.wall += seconds
        self._take(self.timeline.poll(self.wall))

    def _take(self, judged):
        if judged.jump:
            self.jumps.append(judged.jump)
        self.through += [(item.name, item.stamp) for item in judged.items]

    def ticks(self, begin, count):
        for k in range(count):
            for name in self.topics:
                self.say(name, begin + k * DT)


def test_stamps_in_order_pass_at_once():
    run = Run()
    run.ticks(0, 40)
    assert len(run.through) == 80
    assert not run.jumps
    assert not run.timeline.counts


@pytest.mark.parametrize("shift", [3600 * S, -3600 * S, 10 * S, -10 * S])
@pytest.mark.parametrize("topics", [("a",), ("a", "b")])
def test_one_wrong_stamp_is_left_out_and_nothing_else(shift, topics):
    run = Run(topics)
    run.ticks(7200 * S, 10)
    run.say("a", 7200 * S + 9 * DT + shift)
    run.ticks(7200 * S + 10 * DT, 10)
    assert len(run.through) == 20 * len(topics)
    assert not run.jumps
    assert run.timeline.counts["ahead" if shift > 0 else "back"] == 1
    assert "a: its stamp" in run.timeline.refusals[0]


@pytest.mark.parametrize("after", [0, 55 * S, 95 * S, 1000 * S])
@pytest.mark.parametrize("topics", [("a",), ("a", "b")])
def test_a_jump_that_the_next_messages_confirm_is_taken_and_loses_none_of_them(after, topics):
    run = Run(topics)
    run.ticks(100 * S, 10)
    before = len(run.through)
    run.ticks(after, 5)
    (jump,) = run.jumps
    assert jump.is_back == (after < 100 * S)
    assert len(run.through) - before == 5 * len(topics)
    assert run.timeline.now == after + 4 * DT


def test_two_topics_confirm_a_jump_at_once():
    run = Run()
    run.ticks(100 * S, 10)
    run.say("a", 0)
    assert not run.jumps
    run.say("b", 0)
    assert len(run.jumps) == 1
    assert run.through[-2:] == [("a", 0), ("b", 0)]


def test_the_same_wrong_message_again_and_again_confirms_nothing():
    run = Run(("a",))
    run.ticks(100 * S, 10)
    for _ in range(10 * CONFIRMED):
        run.say("a", 900 * S)
    assert not run.jumps


def test_a_step_back_is_believed_in_silence_but_not_a_step_ahead():
    run = Run(("a",))
    run.ticks(100 * S, 10)
    run.say("a", 0)
    run.silence(SILENCE_S / 2)
    assert not run.jumps
    run.silence(SILENCE_S)
    assert len(run.jumps) == 1
    run.say("a", 900 * S)
    run.silence(10.0)
    assert len(run.jumps) == 1


def test_a_first_stamp_that_was_wrong_is_put_right():
    run = Run()
    run.say("a", 3600 * S)
    run.ticks(0, 10)
    assert run.timeline.now == 9 * DT
    assert run.through[-1] == ("b", 9 * DT)
    assert len(run.jumps) == 1


def test_plans_may_lie_ahead_and_make_no_time():
    timeline = Timeline(DT, plans=["plan"])
    for name, stamp in (("a", 0), ("plan", S), ("a", DT)):
        assert timeline.judge(Item(name, stamp, None), 0.0).items
    assert timeline.now == DT
    assert not timeline.judge(Item("plan", 100 * S, None), 0.0).items


def test_a_late_stream_is_not_time_that_goes_back():
    """A node that was stopped catches up: its inputs are old, but each goes on in order."""
    run = Run()
    for k in range(100):
        run.say("a", k * DT)
    for k in range(100):
        run.say("b", k * DT)
    assert len(run.through) == 200
    assert not run.jumps


@given(
    st.lists(st.tuples(st.sampled_from("ab"), st.integers(-(2**31) * S, 2**31 * S)), max_size=60)
)
def test_whatever_comes_good_input_is_heard_again_within_a_second(invalid):
    run = Run()
    run.ticks(100 * S, 5)
    for name, stamp in invalid:
        run.say(name, stamp)
    run.ticks(101 * S, 20)
    run.through.clear()
    run.ticks(102 * S, 20)
    assert len(run.through) == 40
