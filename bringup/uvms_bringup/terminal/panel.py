"""A glance as a panel of rich, from 40 columns on."""

from collections.abc import Iterator, Sequence

from rich import box
from rich.console import RenderableType
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from uvms_bringup.terminal import words
from uvms_bringup.terminal.glance import Bounded, Glance, Health, Thruster
from uvms_core import diagnostics
from uvms_core.battery import LOW

LEAST_COLUMNS = 40
"""A narrower terminal gets lines."""
BESIDE_COLUMNS = 90
"""From here on the thrusters stand beside the rest, not below."""
MOST_COLUMNS = 130
FRAME = 4
"""Columns of the frame with its padding."""
GAP = 2
LABEL, NAME = 9, 14
"""Columns of a value's label, and of a thruster's name."""
NEAR = 0.8
"""Share of its limit from which on a thruster's bar is yellow."""
GOOD, NEAR_LIMIT, BAD, DIM = "green", "yellow", "bold red", "dim"
STYLES = {diagnostics.OK: GOOD, diagnostics.WARN: NEAR_LIMIT}

Row = tuple[str, Text]


def panel(glance: Glance, title: str, columns: int, is_ascii: bool = False) -> RenderableType:
    """The panel.

    Args:
        title: of the frame.
        columns: of the terminal.
        is_ascii: whether it can show nothing else.
    """
    width = min(columns, MOST_COLUMNS)
    inside = width - FRAME
    is_beside = width >= BESIDE_COLUMNS
    half = (inside - GAP) // 2 if is_beside else inside
    block = "#" if is_ascii else "█"
    state = _grid(_state_rows(glance, half, block), half)
    thrusters = _grid(_thruster_rows(glance, half, block), half, NAME)
    body = Table.grid(padding=(0, GAP if is_beside else 0, 0, 0))
    if is_beside:
        body.add_row(state, thrusters)
    else:
        body.add_row(state)
        body.add_row(thrusters)
    whole = Table.grid()
    whole.add_row(body)
    whole.add_row(_grid(_text_rows(glance), inside))
    frame = box.ASCII if is_ascii else box.ROUNDED
    return Panel(whole, title=Text(title), title_align="left", width=width, box=frame)


def _grid(rows: Iterator[Row], width: int, name: int = LABEL) -> Table:
    grid = Table.grid(padding=(0, 1, 0, 0))
    grid.add_column(width=name, no_wrap=True, overflow="ellipsis", style="cyan")
    grid.add_column(width=width - name - 1, no_wrap=True, overflow="ellipsis")
    for label, text in rows:
        grid.add_row(Text(label), text)
    return grid


def _state_rows(glance: Glance, width: int, block: str) -> Iterator[Row]:
    own = glance.measured
    yield "time", Text(words.time_text(glance))
    done = f" {glance.share:4.0%}"
    room = width - LABEL - 1 - len(done)
    yield "done", _filled(glance.share, room, block).append(done)
    yield "pace", Text(f"{words.pace_text(glance)}, {words.left_text(glance)}")
    yield "tool off", _bounded(own.tool)
    yield "roll", _bounded(own.roll)
    yield "pitch", _bounded(own.pitch)
    if own.battery is not None:
        low = own.battery.share < LOW
        yield "battery", Text(words.battery_text(own.battery), style=BAD if low else "")
    yield "restoring", Text(words.push_text(own.restoring))
    yield "coupling", Text(words.push_text(own.coupling))
    yield "external", Text(words.push_text(own.external))


def _thruster_rows(glance: Glance, width: int, block: str) -> Iterator[Row]:
    room = width - NAME - 1
    thrusters = glance.measured.thrusters
    names = shortened([thruster.name for thruster in thrusters], NAME)
    for name, thruster in zip(names, thrusters, strict=True):
        text = words.thrust_text(thruster)
        style = _thrust_style(thruster)
        bar = _centred(thruster.share, (room - len(text) - 2) // 2, block, style)
        yield name, Text.assemble((text, style), " ", bar)


def _text_rows(glance: Glance) -> Iterator[Row]:
    """What may be long."""
    yield "phase", Text(_one_line(glance.phase) or words.NOTHING)
    yield "health", _health(glance.measured.health)
    events = glance.measured.events
    if not events:
        yield "events", Text(words.NOTHING, style=DIM)
    for index, (time, text) in enumerate(reversed(events)):
        yield "" if index else "events", Text(f"{time:.1f} s: {_one_line(text)}")


def _bounded(bounded: Bounded) -> Text:
    return Text(words.bounded_text(bounded), style=BAD if bounded.is_exceeded else "")


def _health(health: Health | None) -> Text:
    if health is None:
        return Text(words.NOTHING)
    return Text(_one_line(health.words), style=STYLES.get(health.level, BAD))


def _thrust_style(thruster: Thruster) -> str:
    if thruster.is_saturated:
        return BAD
    return NEAR_LIMIT if abs(thruster.share) >= NEAR else GOOD


def _filled(share: float, room: int, block: str) -> Text:
    full = round(share * room)
    return Text(block * full, style=GOOD).append("." * (room - full), style=DIM)


def _centred(share: float, half: int, block: str, style: str) -> Text:
    """A bar from the middle: to the left astern, to the right ahead, `half` columns each."""
    cells = round(abs(share) * half)
    empty, none, full = "." * (half - cells), "." * half, block * cells
    if share < 0.0:
        return Text.assemble((empty, DIM), (full, style), "|", (none, DIM))
    return Text.assemble((none, DIM), "|", (full, style), (empty, DIM))


def shortened(names: Sequence[str], columns: int) -> list[str]:
    """Names of words joined by underscores; where one is too long all words are cut alike."""
    for letters in range(max(map(len, names), default=1), 0, -1):
        short = ["_".join(word[:letters] for word in name.split("_")) for name in names]
        if max(map(len, short), default=0) <= columns and len(set(short)) == len(set(names)):
            return short
    return [name[:columns] for name in names]


def _one_line(text: str) -> str:
    return " ".join(text.split())
