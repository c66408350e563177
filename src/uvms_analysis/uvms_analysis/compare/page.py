"""The page of several runs: outcomes, figures with differences, plots laid over one another."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from uvms_analysis.compare.table import Row
from uvms_analysis.outcome import COMPLETED
from uvms_analysis.report import sections
from uvms_analysis.report.facts import Facts
from uvms_analysis.report.html import Cell, Raw, escaped, folded, note, number, table
from uvms_analysis.report.metrics import Metric
from uvms_analysis.report.page import document, embedded, links, write
from uvms_analysis.report.questions import QUESTIONS, Question
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.report.shown import Shown, show

PAGE = "compare.html"


def write_page(
    folder: Path, runs: Sequence[ReportedRun], rows: Sequence[Row], warnings: Sequence[str] = ()
) -> Path:
    """Write the page about several runs; returns it."""
    title = "Comparison of " + ", ".join(run.name for run in runs)
    shown, facts = show(runs), [Facts(run) for run in runs]
    body = [
        '<section id="did-it-work"><h2>Did they work?</h2>',
        *(f'<p class="banner bad">{escaped(text)}</p>' for text in warnings),
        _outcomes(runs),
        "</section>",
        *(_question(question, runs, facts, shown) for question in QUESTIONS),
        '<section id="everything"><h2>Fields that differ</h2>',
        _fields(runs, rows),
        "</section>",
        embedded(shown.data()),
    ]
    anchors = [("did-it-work", "Did they work?"), *links()]
    return write(folder / PAGE, document(title, "".join(body), anchors))


def _outcomes(runs: Sequence[ReportedRun]) -> str:
    head = ("run", "outcome", "reasons", "scenario and seed", "duration", "judged by")
    rows = [
        (
            run.name,
            str(run.summary.get("outcome")),
            "; ".join(run.summary.get("reasons") or ()) or "–",
            run.title,
            f"{number(run.summary.get('sim_duration_s'))} s",
            str(run.summary.get("judged_by") or "–"),
        )
        for run in runs
    ]
    return table(head, rows)


def _question(
    question: Question, runs: Sequence[ReportedRun], facts: Sequence[Facts], shown: Shown
) -> str:
    head = ("figure", *(run.name for run in runs))
    rows = [(", ".join(filter(None, (metric.name, metric.unit))), *_cells(metric, runs, facts))
            for metric in question.metrics]  # fmt: skip
    return (
        f'<section id="{question.key}"><h2>{escaped(question.title)}</h2>'
        f"{table(head, rows)}"
        '<p class="caption">In brackets: less the first run. ★ marks the best of the runs that are'
        " completed; a run that ended early can have small errors.</p>"
        f"{sections.plots(question.groups, shown)}</section>"
    )


def _cells(metric: Metric, runs: Sequence[ReportedRun], facts: Sequence[Facts]) -> Iterator[Cell]:
    """The figure of each run, with its difference from the first run, the best one marked."""
    values = [metric.value(each.values) for each in facts]
    best = best_of(metric, values, [run.summary.get("outcome") == COMPLETED for run in runs])
    for count, value in enumerate(values):
        if value is None:
            why = facts[count].why_not(metric.key) or "not in the log"
            yield Raw(f'<span class="missing">missing: {escaped(why)}</span>')
            continue
        text = number(value)
        if count and (first := values[0]) is not None:
            text += f" ({_difference(value, first)})"
        yield Raw(f'<span class="best">★ best: {text}</span>') if count in best else text


def best_of(
    metric: Metric, values: Sequence[float | None], counts: Sequence[bool]
) -> tuple[int, ...]:
    """Which runs are best; none where no figure is better than another, or all are alike.

    Args:
        metric: says what is better.
        values: of each run, None where it is missing.
        counts: whether the run can be best.
    """
    known = {k: value for k, value in enumerate(values) if value is not None and counts[k]}
    if not metric.better or len(known) < 2:
        return ()
    best = min(known.values()) if metric.better == "low" else max(known.values())
    found = tuple(k for k, value in known.items() if _are_alike(value, best))
    return () if len(found) == len(known) else found


def _are_alike(one: float, two: float) -> bool:
    """Whether the page shows the same number for both."""
    return number(one) == number(two)


def _difference(value: float, first: float) -> str:
    """The value less that of the first run, and in per cent of it."""
    if _are_alike(value, first):
        return "the same"
    change = value - first
    share = f", {100 * change / abs(first):+.3g} %" if first else ""
    return f"{'+' if change > 0 else ''}{number(change)}{share}"


def _fields(runs: Sequence[ReportedRun], rows: Sequence[Row]) -> str:
    lines = [
        (row.name, row.unit, *row.texts, "" if row.ratio is None else f"{row.ratio:.3g}")
        for row in rows
    ]
    head = ("field", "unit", *(run.name for run in runs), "ratio, last to first")
    return folded("Fields of the summaries", table(head, lines)) if lines else note("None.")
