"""The page of a comparison: table and figures in one self-contained HTML file."""

import base64
import html
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from uvms_analysis.analysis import Analysis
from uvms_analysis.compare.figures import FIGURES
from uvms_analysis.compare.table import Row
from uvms_analysis.errors import LogError, determine
from uvms_analysis.report import style
from uvms_analysis.report.page import CSS

PAGE = "compare.html"


def write(
    folder: Path, runs: Mapping[str, Analysis], rows: Sequence[Row], warnings: Sequence[str] = ()
) -> Path:
    """Draw the figures and write the page; returns it."""
    names = list(runs)
    title = "Comparison of " + ", ".join(names)
    body = [
        f"<h1>{html.escape(title)}</h1>",
        *(f'<p class="banner bad">{html.escape(text)}</p>' for text in warnings),
        *(_figure(folder, name, runs) for name in FIGURES),
        "<h2>Fields that differ</h2>",
        _table(names, rows),
    ]
    path = folder / PAGE
    text = (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{html.escape(title)}</title>\n<style>\n{CSS.read_text(encoding='utf-8')}</style>"
        f"\n</head>\n<body>\n<main>\n{''.join(body)}\n</main>\n</body>\n</html>\n"
    )
    try:
        path.write_text(text, encoding="utf-8", errors="replace")
    except OSError as fault:
        raise LogError(f"{path}: cannot be written: {fault.strerror}") from fault
    return path


def _figure(folder: Path, name: str, runs: Mapping[str, Analysis]) -> str:
    caption, draw = FIGURES[name]
    path = folder / f"compare_{name}.png"
    words = f"<figcaption>{html.escape(caption)}</figcaption>"
    try:
        with style.settings():
            figure = determine(partial(draw, runs))
            figure.savefig(path)
    except LogError as fault:
        return f'<figure>{words}<p class="note">No figure: {html.escape(str(fault))}</p></figure>'
    except OSError as fault:
        raise LogError(f"{path}: cannot be written: {fault.strerror}") from fault
    data = base64.b64encode(path.read_bytes()).decode()
    image = f'<img alt="{html.escape(caption)}" src="data:image/png;base64,{data}">'
    return f"<figure>{image}{words}</figure>"


def _table(names: Sequence[str], rows: Sequence[Row]) -> str:
    head = "".join(f"<th>{html.escape(name)}</th>" for name in ("field", "unit", *names, "ratio"))
    lines = []
    for row in rows:
        ratio = "" if row.ratio is None else f"{row.ratio:.3g}"
        cells = (row.name, row.unit, *row.texts, ratio)
        lines.append("".join(f"<td>{html.escape(cell)}</td>" for cell in cells))
    return f"<table><tr>{head}</tr>{''.join(f'<tr>{line}</tr>' for line in lines)}</table>"
