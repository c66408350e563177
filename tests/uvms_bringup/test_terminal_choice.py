"""Which terminals get the panel, and that it leaves them as they were."""

import sys

import pytest
from pseudo_terminal import Terminal

CHOICE = "from uvms_bringup.terminal.live_panel import can_draw; print('panel:', can_draw())"
DRAWN = """
import os, sys
from uvms_bringup.terminal.glance import Bounded, Glance, Measured
from uvms_bringup.terminal.live_panel import LivePanel
nothing = Bounded(None, 1.0, "mm")
glance = Glance(1.0, 2.0, None, "", Measured(nothing, nothing, nothing))
panel = LivePanel("title")
panel.start()
panel.draw(glance)
os.write(2, b"from a library\\n")
panel.draw(glance)
print("from the program")
print("an error", file=sys.stderr)
panel.draw(glance)
os.write(2, b"at the end\\n")
panel.stop()
os.write(2, b"afterwards\\n")
"""
LEFT = ["from a library", "from the program", "an error", "at the end", "afterwards"]


def shown(script, columns, rows=60, **environment):
    with Terminal([sys.executable, "-c", script], columns, rows, **environment) as terminal:
        assert terminal.end(60.0) == 0, terminal.raw
    return terminal


@pytest.mark.parametrize(
    ("columns", "environment", "answer"),
    [
        (40, {}, True),
        (39, {}, False),
        (80, {"NO_COLOR": "1"}, False),
        (80, {"TERM": "dumb"}, False),
    ],
    ids=["narrow", "too narrow", "no colour", "dumb"],
)
def test_a_terminal_gets_the_panel_where_it_can_show_it(columns, environment, answer):
    terminal = shown(CHOICE, columns, **environment)
    assert f"panel: {answer}" in terminal.raw
    assert "\x1b" not in terminal.raw


@pytest.mark.parametrize("stream", ["stdout", "stderr"])
def test_a_stream_that_goes_elsewhere_gets_lines(stream):
    elsewhere = f"import os, sys; sys.{stream} = open(os.devnull, 'w')\n"
    to = "stderr" if stream == "stdout" else "stdout"
    script = elsewhere + CHOICE.replace("can_draw())", f"can_draw(), file=sys.{to})")
    assert "panel: False" in shown(script, 80).raw


@pytest.mark.parametrize("rows", [60, 5], ids=["high", "lower than the panel"])
def test_what_is_written_meanwhile_stays_and_the_panel_goes(rows):
    terminal = shown(DRAWN, 80, rows)
    assert "title" in terminal.raw
    assert terminal.screen().text.splitlines() == LEFT
    assert terminal.screen().is_cursor_shown
