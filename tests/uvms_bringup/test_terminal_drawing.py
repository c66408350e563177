"""A glance drawn as a panel at several widths, and as a line: every value with its unit."""

from dataclasses import replace

import pytest
from rich.console import Console

from uvms_bringup.terminal.glance import Battery, Bounded, Glance, Health, Measured, Push, Thruster
from uvms_bringup.terminal.line import line
from uvms_bringup.terminal.panel import BESIDE_COLUMNS, MOST_COLUMNS, panel, shortened
from uvms_core import diagnostics

MEASURED = Measured(
    tool=Bounded(12.5, 200.0, "mm"),
    roll=Bounded(-1.25, 5.0, "deg"),
    pitch=Bounded(0.5, 4.0, "deg"),
    thrusters=(
        Thruster("vertical_aft_port", 49.0, -49.0, 49.0, is_saturated=True),
        Thruster("vertical_aft_starboard", -20.0, -40.0, 50.0),
    ),
    restoring=Push(10.0, 1.5),
    coupling=Push(2.25, 0.75),
    external=Push(3.0, 0.125),
    health=Health(diagnostics.WARN, "navigation", "no DVL"),
    events=((12.0, "payload 2 kg"), (30.5, "gust begins")),
)
GLANCE = Glance(45.0, 900.0, 9.5, "goal 1 of 2 (path) active", MEASURED)
SILENT = Measured(
    Bounded(None, 200.0, "mm"),
    Bounded(None, 5.0, "deg"),
    Bounded(None, 4.0, "deg"),
    (Thruster("main", None, -98.0, 98.0),),
)
WIDTHS = (40, 80, 200)
NAN = float("nan")


def drawn(glance: Glance, columns: int, is_ascii: bool = False, colours: bool = False) -> str:
    console = Console(
        width=columns, force_terminal=colours, color_system="standard" if colours else None
    )
    with console.capture() as capture:
        console.print(panel(glance, "hover", columns, is_ascii))
    return capture.get()


def row(text: str, label: str) -> str:
    """What stands beside a label."""
    return next(each for each in text.splitlines() if f" {label} " in each).split(label, 1)[1]


@pytest.mark.parametrize("columns", WIDTHS)
def test_every_value_is_there_with_its_unit(columns):
    text = drawn(GLANCE, columns)
    for label, value in {
        "time": "45.0 of 900 s",
        "done": "5%",
        "pace": "9.5x real time, 1:30 left",
        "phase": "goal 1 of 2 (path) active",
        "tool off": "12.50 mm (limit 200)",
        "roll": "-1.25 deg (limit 5)",
        "pitch": "0.50 deg (limit 4)",
        "restoring": "10.00 N, 1.50 N m",
        "coupling": "2.25 N, 0.75 N m",
        "external": "3.00 N, 0.12 N m",
        "health": "WARN navigation: no DVL",
        "events": "30.5 s: gust begins",
    }.items():
        assert value in row(text, label), label
    assert "12.0 s: payload 2 kg" in text
    assert "+49.0 N!" in text
    assert "-20.0 N " in text


LOW = Glance(45.0, 900.0, 9.5, "", replace(MEASURED, battery=Battery(0.153, 14.25, 180.4)))


@pytest.mark.parametrize("columns", WIDTHS)
def test_a_battery_has_a_line_where_there_is_one(columns):
    assert "15.3%, 14.2 V, 180 W !" in row(drawn(LOW, columns), "battery")
    full = replace(LOW, measured=replace(MEASURED, battery=Battery(0.9, 16.0, 60.0)))
    assert "90.0%, 16.0 V, 60 W " in row(drawn(full, columns), "battery")
    assert "!" not in row(drawn(full, columns), "battery").split("W")[1][:3]
    unknown = replace(LOW, measured=replace(MEASURED, battery=Battery(NAN, 16.0, NAN)))
    assert "-, 16.0 V, -" in row(drawn(unknown, columns), "battery")
    assert "battery" not in drawn(GLANCE, columns)
    assert "battery 15.3%, 14.2 V, 180 W !" in line(LOW)
    assert "battery" not in line(GLANCE)


@pytest.mark.parametrize("columns", [*WIDTHS, BESIDE_COLUMNS - 1, BESIDE_COLUMNS, 131])
def test_no_line_is_wider_than_the_terminal(columns):
    lines = drawn(GLANCE, columns).splitlines()
    assert {len(each) for each in lines} == {min(columns, MOST_COLUMNS)}
    assert len(lines) <= 18


@pytest.mark.parametrize("columns", WIDTHS)
def test_what_has_not_come_is_a_dash(columns):
    text = drawn(Glance(0.0, 20.0, None, "", SILENT), columns)
    for label in ("pace", "phase", "tool off", "roll", "restoring", "external", "health", "events"):
        assert row(text, label).strip(" │").startswith("-"), label
    assert "0.00" not in text
    assert "ok" not in text


def test_what_exceeds_its_limit_is_marked_with_and_without_colours():
    tilted = replace(MEASURED, roll=Bounded(-5.01, 5.0, "deg"), pitch=Bounded(4.0, 4.0, "deg"))
    text = drawn(replace(GLANCE, measured=tilted), 80)
    assert "-5.01 deg (limit 5) !" in row(text, "roll")
    assert "!" not in row(text, "pitch")
    coloured = drawn(replace(GLANCE, measured=tilted), 80, colours=True)
    red = "\x1b[1;31m"
    assert f"{red}-5.01 deg" in coloured
    assert f"{red} +49.0 N!" in coloured
    assert f"{red}4.00" not in coloured


def test_bars_are_shares_of_the_limit_in_their_direction():
    text = drawn(GLANCE, 80)
    full, half = (
        next(each for each in text.splitlines() if unit in each) for unit in ("+49.0 N", "-20.0 N")
    )
    room = full.split("N!")[1].strip(" │").partition("|")
    assert room[2] == "█" * len(room[2])
    assert set(room[0]) == {"."}
    astern, _, ahead = half.split("N ")[1].strip(" │").partition("|")
    assert abs(astern.count("█") - len(astern) / 2) <= 0.5
    assert set(ahead) == {"."}


@pytest.mark.parametrize(
    ("thrust", "share"), [(25.0, 0.5), (-40.0, -1.0), (80.0, 1.0), (0.0, 0.0), (None, 0.0)]
)
def test_the_share_of_a_thruster(thrust, share):
    assert Thruster("a", thrust, -40.0, 50.0).share == share


def test_a_thruster_without_reverse_has_no_share_astern():
    assert Thruster("a", -1.0, 0.0, 50.0).share == 0.0


def test_a_terminal_of_plain_ascii_gets_nothing_else():
    assert drawn(GLANCE, 80, is_ascii=True).isascii()


def test_texts_of_several_lines_stay_one_row():
    faulty = replace(MEASURED, health=Health(diagnostics.ERROR, "plant", "one\ntwo"))
    text = drawn(replace(GLANCE, measured=faulty), 80)
    assert "ERROR plant: one two" in text
    assert "\n" not in line(replace(GLANCE, measured=faulty))


def test_names_are_cut_alike_and_stay_apart():
    names = ["vertical_fore_port", "vertical_fore_starboard", "main"]
    assert shortened(names, 14) == ["vert_fore_port", "vert_fore_star", "main"]
    assert shortened(["a_one", "b"], 14) == ["a_one", "b"]
    assert shortened([], 14) == []


def test_a_line_says_the_same():
    assert line(GLANCE).strip() == (
        "45.0 of 900 s  9.5x real time  goal 1 of 2 (path) active  tool 12.50 mm"
        "  roll -1.25 deg  pitch 0.50 deg  at its limit: vertical_aft_port"
        "  health WARN navigation: no DVL"
    )


def test_a_line_marks_limits_and_dashes():
    tilted = replace(SILENT, roll=Bounded(-6.0, 5.0, "deg"))
    text = line(Glance(1.0, 20.0, None, "no goal", tilted))
    assert text.strip() == "1.0 of 20 s  -  no goal  tool -  roll -6.00 deg!  pitch -  health -"


def test_no_value_is_minus_zero():
    level = replace(MEASURED, roll=Bounded(-0.001, 5.0, "deg"))
    assert "roll 0.00 deg" in line(replace(GLANCE, measured=level))
