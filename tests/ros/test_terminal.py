"""Runs on a pseudo terminal: a panel while they go on, a clean screen at their end; else lines."""

import re
import sys

from graph import finished, own_domain, uvms
from pseudo_terminal import Terminal

RUN = ("run", "--composed")
WHOLE = "x real time.*╯"
ESCAPE, FRAME = "\x1b", "│"
LINE = re.compile(
    r"^ *\d+\.\d of \d+ s  .*  tool .* mm  roll .* deg  pitch .* deg .*health ok$", re.M
)


def terminal(folder, command, duration, columns=80, **environment):
    arguments = [*command, "hover", "--duration", duration, "--output", str(folder)]
    arguments = [sys.executable, "-m", "uvms_bringup.cli", *arguments]
    return Terminal(arguments, columns, **{**own_domain(), **environment})


def check_clean(screen):
    assert FRAME not in screen.text
    assert screen.is_cursor_shown
    assert "log: " in screen.text.splitlines()[-2]


def test_a_run_shows_its_panel_and_leaves_its_summary(tmp_path):
    with terminal(tmp_path / "a", RUN, "20") as shown:
        shown.read_until(WHOLE, 200.0)
        panel = shown.screen().text
        assert shown.end(100.0) == 0, shown.raw
    for words in (
        "of 20 s",
        "no goal",
        "mm (limit 200)",
        "deg (limit 5)",
        " N, ",
        "ok",
        "side_fore",
    ):
        assert words in panel, panel
    assert panel.count("╭─ hover") == 1  # drawn in the place of the one before
    check_clean(shown.screen())
    assert "outcome: completed" in shown.screen().text


def test_ctrl_c_takes_the_panel_away(tmp_path):
    with terminal(tmp_path / "a", RUN, "6000") as shown:
        shown.read_until(WHOLE, 200.0)
        shown.press_ctrl_c()
        assert shown.end(60.0) == 130, shown.raw
    check_clean(shown.screen())
    assert "stopped by SIGINT" in shown.screen().text
    assert "Traceback" not in shown.raw


def test_a_pipe_gets_lines(tmp_path):
    piped = finished(uvms(tmp_path / "a", "simulate", "hover", "--duration", "5"))
    assert ESCAPE not in piped.out + piped.err
    assert LINE.search(piped.err), piped.err
