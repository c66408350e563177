"""Small pieces of HTML: numbers, tables that become lists on narrow screens, notes."""

import html
from collections.abc import Sequence
from typing import Any, NamedTuple


class Raw(NamedTuple):
    """A text that is HTML already."""

    text: str


Cell = str | Raw


def escaped(text: Any) -> str:
    """A text so that a page shows it as it is."""
    return text.text if isinstance(text, Raw) else html.escape(str(text))


def number(value: Any) -> str:
    """A value as it is shown: four digits; a dash for what is missing."""
    if value is None:
        return "–"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return str(value)
    if isinstance(value, int) or (value == int(value) and abs(value) < 1e6):
        return str(int(value))
    return f"{value:.4g}" if abs(value) < 1e4 or abs(value) >= 1e7 else f"{value:.0f}"


def table(
    head: Sequence[str], rows: Sequence[Sequence[Cell]], name: str = "", kind: str = ""
) -> str:
    """A table; on a narrow screen each cell carries the name of its column."""
    if not rows:
        return ""
    caption = f"<caption>{escaped(name)}</caption>" if name else ""
    top = "".join(f'<th scope="col">{escaped(text)}</th>' for text in head)
    lines = []
    for first, *rest in rows:
        cells = "".join(
            f'<td data-label="{html.escape(label)}">{escaped(cell)}</td>'
            for label, cell in zip(head[1:], rest, strict=True)
        )
        lines.append(f'<tr><th scope="row">{escaped(first)}</th>{cells}</tr>')
    body = "".join(lines)
    return (
        f'<table class="{kind}">{caption}<thead><tr>{top}</tr></thead><tbody>{body}</tbody></table>'
    )


def note(text: str) -> str:
    """A remark that should not be overlooked."""
    return f'<p class="note">{escaped(text)}</p>'


def folded(title: str, body: str, is_open: bool = False) -> str:
    """Something that can be opened and closed, by key as well; open on paper and without script."""
    word, state = ("", "true") if is_open else (" closed", "false")
    return (
        f'<section class="fold{word}"><h3><button type="button" aria-expanded="{state}">'
        f'{escaped(title)}</button></h3><div class="folded">{body}</div></section>'
    )
