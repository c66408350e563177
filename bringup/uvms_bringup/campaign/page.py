"""The page of a campaign: one self-contained HTML file."""

import base64
import html
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from uvms_analysis.report import style
from uvms_analysis.report.page import CSS
from uvms_bringup.campaign.figures import distribution
from uvms_bringup.campaign.row import Row
from uvms_bringup.errors import CampaignError

MOST_FAILURES = 200
"""Failed runs that the page lists; the table has all of them."""

_OWN_STYLE = """
main { max-width: 76rem; }
table.cases td, table.cases th { padding: 0.2rem 0.6rem; text-align: right; }
table.cases td:first-child, table.cases th:first-child { text-align: left; }
tr.bad td:first-child { border-left: 4px solid #d55e00; }
tr.good td:first-child { border-left: 4px solid #0072b2; }
td.beside { color: #777; }
"""


def write_page(path: Path, summary: Mapping[str, Any], rows: Sequence[Row]) -> None:
    """Write the page.

    Args:
        summary: the content of `summary.json`.
    """
    title = f"Campaign {summary['campaign']}"
    cases = summary["cases"]
    fields = list(dict.fromkeys(name for case in cases.values() for name in case["fields"]))
    body = [
        f"<h1>{html.escape(title)}</h1>",
        f"<p>{html.escape(summary['description'])}</p>",
        _banner(summary),
        "<h2>Cases</h2>",
        _cases(cases),
        *(_fields(name, cases) for name in fields),
        "<h2>Distributions</h2>",
        *_figures(fields, cases, list(rows)),
        "<h2>Failed runs</h2>",
        _failures(path.parent, rows),
    ]
    try:
        path.write_text(_document(title, "\n".join(body)), encoding="utf-8")
    except OSError as fault:
        raise CampaignError(f"{path}: cannot be written: {fault.strerror}") from fault


def _document(title: str, body: str) -> str:
    css = CSS.read_text(encoding="utf-8") + _OWN_STYLE
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{html.escape(title)}</title>\n<style>\n{css}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _banner(summary: Mapping[str, Any]) -> str:
    runs, planned, passed = (summary[key] for key in ("runs", "planned", "passed"))
    kind = "good" if passed == runs == planned else "bad"
    text = f"{passed} of {runs} runs kept all that is required ({interval(summary)})"
    if runs < planned:
        text += f"; {planned - runs} of {planned} are not made yet"
    return f'<p class="banner {kind}"><strong>{text}</strong></p>'


def interval(values: Mapping[str, Any]) -> str:
    """The interval of a pass rate in words."""
    low, high = values["wilson_95"]
    return f"95 % interval of the rate {100 * low:.0f} to {100 * high:.0f} %"


def _cases(cases: Mapping[str, Any]) -> str:
    names = list(dict.fromkeys(name for case in cases.values() for name in case["baselines"]))
    head = ["case", "passed", "95 % interval", "outcomes", *names]
    lines = []
    for name, case in cases.items():
        low, high = case["wilson_95"]
        outcomes = ", ".join(f"{count} {word}" for word, count in case["outcomes"].items())
        cells = [
            html.escape(name),
            f"{case['passed']} of {case['runs']}",
            f"{100 * low:.0f}–{100 * high:.0f} %",
            html.escape(outcomes),
        ]
        own = (case["baselines"].get(one) for one in names)
        beside = ["–" if one is None else f"{one['passed']} of {one['runs']}" for one in own]
        lines.append(_line(case["passed"] == case["runs"], cells, beside))
    return _table(head, lines)


def _fields(field: str, cases: Mapping[str, Any]) -> str:
    """The statistics of one numeric field, with the baselines' medians beside them."""
    shown = {
        name: case
        for name, case in cases.items()
        if "median" in case["fields"].get(field, {})
    }  # fmt: skip
    if not shown:
        return ""
    names = list(dict.fromkeys(name for case in shown.values() for name in case["baselines"]))
    head = ["case", "required", "median", "p95", "worst", "seed of the worst", *names]
    lines = []
    for name, case in shown.items():
        found = case["fields"][field]
        good = found["unknown"] == 0 and not found["broken"]
        cells = [html.escape(name), html.escape(found["bound"])]
        cells += [number(found[key]) for key in ("median", "p95", "worst")]
        cells.append("–" if found["worst_seed"] is None else str(found["worst_seed"]))
        own = (case["baselines"].get(one, {"fields": {}})["fields"].get(field) for one in names)
        lines.append(_line(good, cells, [number((one or {}).get("median")) for one in own]))
    return f"<h3>{html.escape(field)}</h3>{_table(head, lines)}"


def number(value: float | None) -> str:
    """A number as it is shown."""
    return "–" if value is None else f"{value:.4g}"


def _line(good: bool, cells: Sequence[str], beside: Sequence[str]) -> str:
    inner = "".join(f"<td>{cell}</td>" for cell in cells)
    inner += "".join(f'<td class="beside">{cell}</td>' for cell in beside)
    return f'<tr class="{"good" if good else "bad"}">{inner}</tr>'


def _table(head: Sequence[str], lines: Sequence[str]) -> str:
    cells = "".join(f"<th>{html.escape(name)}</th>" for name in head)
    return f'<table class="cases"><tr>{cells}</tr>{"".join(lines)}</table>'


def _figures(fields: Sequence[str], cases: Mapping[str, Any], rows: list[Row]) -> Iterator[str]:
    for field in fields:
        with style.settings():
            figure = distribution(field, dict(cases), rows)
            if figure is None:
                continue
            data = io.BytesIO()
            figure.savefig(data, format="png")
        image = base64.b64encode(data.getvalue()).decode()
        name = html.escape(field)
        yield f'<figure><img alt="{name}" src="data:image/png;base64,{image}"></figure>'


def _failures(folder: Path, rows: Sequence[Row]) -> str:
    failed = [row for row in rows if not row["passed"] and not row["baseline_of"]]
    if not failed:
        return "<p>None.</p>"
    items = (
        f"<li><strong>{html.escape(row['case'])}, seed {row['seed']}</strong>:"
        f" {html.escape('; '.join(dict.fromkeys([*row['failed'], *row.get('reasons', ())])))}</li>"
        for row in failed[:MOST_FAILURES]
    )
    more = len(failed) - MOST_FAILURES
    note = f"<p>and {more} more, which the table has</p>" if more > 0 else ""
    again = html.escape(f"uvms simulate --again {folder} CASE SEED")
    how = f"<p>Any of them again, with its log: <code>{again}</code></p>"
    return f"{how}<ul>{''.join(items)}</ul>{note}"
