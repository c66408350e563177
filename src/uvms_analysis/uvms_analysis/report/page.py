"""The page about a run, or about several: one self-contained HTML file."""

import base64
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.report import sections
from uvms_analysis.report.facts import Facts
from uvms_analysis.report.html import escaped, folded, note, number, table
from uvms_analysis.report.questions import QUESTIONS, Question
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.report.shown import Shown

HERE = Path(__file__).parent
CSS = HERE / "page.css"
SCRIPTS = (HERE / "uplot" / "uPlot.iife.min.js", HERE / "values.js", HERE / "drawing.js",
           HERE / "page.js")  # fmt: skip
PLOT_CSS = HERE / "uplot" / "uPlot.min.css"

CONTROLS = """
<form class="window" aria-label="Time that the plots show">
<label>plots from <input id="from" type="number" step="any" inputmode="decimal"> s</label>
<label>to <input id="to" type="number" step="any" inputmode="decimal"> s</label>
<button type="submit">Show</button><button type="reset">Whole run</button>
<output id="now" aria-live="off"></output></form>
"""
HELP = (
    "Drag over a plot to zoom in; all plots follow. Double-click shows the whole run again. With"
    " the keyboard: Tab to a plot, then ← → move the cursor (Shift: ten times as far), + − zoom"
    " around it, Home shows the whole run. Buttons below a plot hide its lines."
)


@dataclass(frozen=True)
class Pictures:
    """What a page shows of the vehicle: a picture (PNG), and a page with its motion in 3-D.

    Either may be missing; then the reason, where there is one, is shown.
    """

    picture: bytes | None = None
    scene: str | None = None
    reasons: tuple[str, ...] = ()


def write_page(
    path: Path,
    log: RunLog,
    summary: Mapping[str, Any],
    shown: Shown | None = None,
    pictures: Pictures = Pictures(),
) -> Path:
    """Write the page about a run and return its path; without `shown` it has no plots."""
    run = ReportedRun(log.path.stem, log, summary)
    shown = shown or Shown()
    data = shown.data(_marks(summary))
    body = "".join((*_body(run, shown, pictures), embedded(data, pictures.scene)))
    return write(path, document(run.title, body, [("did-it-work", "Did it work?"), *links()]))


def _marks(summary: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Events whose time is known; JSON has no NaN."""
    return [
        {"time": event["at_s"], "text": event["text"]}
        for event in summary["events"] or ()
        if math.isfinite(event["at_s"])
    ]


def _body(run: ReportedRun, shown: Shown, pictures: Pictures) -> Sequence[str]:
    facts, summary = Facts(run), run.summary
    values = facts.values  # first, so that the reasons for what is missing are there
    return [
        '<section id="did-it-work"><h2>Did it work?</h2>',
        sections.banner(summary),
        *map(note, sections.notes(summary)),
        sections.cards(facts),
        sections.goals(summary),
        _seen(pictures),
        "</section>",
        *(_question(run, question, facts, shown) for question in QUESTIONS),
        '<section id="everything"><h2>Everything else</h2>',
        folded("All figures", _all(values)),
        folded("About the run", table(("what", "value"), _about(run))),
        *(_attachment(name, run.log) for name in ("config.yaml", "vehicle.yaml")),
        "</section>",
    ]


def _question(run: ReportedRun, question: Question, facts: Facts, shown: Shown) -> str:
    extra = ""
    if question.key == "disturbed":
        extra = sections.events(run.summary)
    elif question.key == "cost":
        extra = sections.energy(run.summary)
    elif question.key == "healthy":
        extra = sections.health(run.log, run.summary)
    intro = f"<p>{escaped(question.intro)}</p>" if question.intro else ""
    return (
        f'<section id="{question.key}"><h2>{escaped(question.title)}</h2>{intro}'
        f"{sections.figures(question.metrics, facts)}{extra}"
        f"{sections.plots(question.groups, shown)}</section>"
    )


def links() -> list[tuple[str, str]]:
    """Anchors and titles of the questions and the rest."""
    return [
        *((question.key, question.title) for question in QUESTIONS),
        ("everything", "Everything else"),
    ]


def _seen(pictures: Pictures) -> str:
    """The picture, and a button that opens the 3-D page in its place."""
    parts = [f'<p class="lack">{escaped(reason)}</p>' for reason in pictures.reasons]
    if pictures.picture is not None:
        data = base64.b64encode(pictures.picture).decode()
        parts.append(
            f'<figure class="picture"><img src="data:image/png;base64,{data}" alt="The vehicle at'
            ' work with the path of its tool, thrusts and disturbance"><figcaption>The vehicle at'
            " work. Ghosts: other postures; tube: true path of the tool, enlarged in the corner;"
            " arrows: thrusts and disturbance at the time of the solid posture.</figcaption>"
            "</figure>"
        )
    if pictures.scene is not None:
        parts.append(
            '<div class="scene"><button type="button" id="open-scene">Show the run in 3-D'
            "</button></div>"
        )
    return "".join(parts)


def _all(values: Mapping[str, Any]) -> str:
    return table(("figure", "value"), [(name, number(value)) for name, value in values.items()])


def _about(run: ReportedRun) -> list[tuple[str, str]]:
    return [*((key, str(value)) for key, value in run.log.run.items()), ("log", run.log.path.name)]


def _attachment(name: str, log: RunLog) -> str:
    if name not in log.attachments:
        return ""
    try:
        text = log.text(name)
    except LogError as fault:
        text = str(fault)
    return folded(name, f"<pre>{escaped(text)}</pre>")


def embedded(data: Mapping[str, Any], scene: str | None = None) -> str:
    """The data of the plots and the 3-D page as text that the page's script reads."""
    found = f'<script type="application/json" id="data">{as_script(data)}</script>'
    if scene is not None:
        found += f'<script type="application/json" id="scene">{as_script(scene)}</script>'
    return found


def as_script(values: Any) -> str:
    """JSON that cannot end the element that it stands in."""
    return json.dumps(values, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def document(title: str, body: str, anchors: Sequence[tuple[str, str]]) -> str:
    """The whole page around a body, with its style, its scripts and links to its sections."""
    style = CSS.read_text(encoding="utf-8") + PLOT_CSS.read_text(encoding="utf-8")
    scripts = "".join(f"<script>{file.read_text(encoding='utf-8')}</script>\n" for file in SCRIPTS)
    menu = "".join(f'<a href="#{key}">{escaped(text)}</a>' for key, text in anchors)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<link rel="icon" href="data:,">\n<title>{escaped(title)}</title>\n'
        f"<style>\n{style}</style>\n</head>\n"
        f'<body class="report">\n<a class="skip" href="#content">Skip to the report</a>\n'
        f"<header><h1>{escaped(title)}</h1></header>\n"
        f'<nav aria-label="Questions">{menu}</nav>\n{CONTROLS}\n'
        f'<main id="content" tabindex="-1">\n<noscript>{note("The plots need JavaScript.")}'
        f'</noscript>\n<p class="caption help">{escaped(HELP)}</p>\n{body}\n</main>\n'
        f"{scripts}</body>\n</html>\n"
    )


def write(path: Path, text: str) -> Path:
    """Write a page.

    Raises:
        LogError: it cannot be written.
    """
    try:
        path.write_text(text, encoding="utf-8", errors="replace")
    except OSError as fault:
        raise LogError(f"{path}: cannot be written: {fault.strerror}") from fault
    return path
