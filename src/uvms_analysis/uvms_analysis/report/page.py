"""The page about a run: one self-contained HTML file."""

import base64
import html
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_analysis.errors import LogError
from uvms_analysis.flat import flatten
from uvms_analysis.log.read import RunLog

CSS = Path(__file__).with_name("page.css")


@dataclass(frozen=True)
class Picture:
    """A figure with its caption, or the reason why it is missing."""

    name: str
    caption: str
    file: Path | None
    reason: str = ""


def write_page(path: Path, log: RunLog, summary: dict[str, Any], pictures: list[Picture]) -> Path:
    """Write the page and return its path."""
    seed = "unknown" if summary["seed"] is None else summary["seed"]
    title = f"{summary['scenario'] or log.path.stem}, seed {seed}"
    body = [
        _head(title),
        _banner(summary),
        _notes(summary),
        _cards(summary),
        *(_figure(picture) for picture in pictures),
        "<h2>Summary</h2>",
        _table(flatten(summary)),
        "<h2>About the run</h2>",
        _table(dict(log.run) | {"log": log.path.name}),
        *(_details(name, log) for name in ("config.yaml", "vehicle.yaml")),
    ]
    try:
        path.write_text(_document(title, "\n".join(body)), encoding="utf-8", errors="replace")
    except OSError as fault:
        raise LogError(f"{path}: cannot be written: {fault.strerror}") from fault
    return path


def _document(title: str, body: str) -> str:
    style = CSS.read_text(encoding="utf-8")
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{html.escape(title)}</title>\n<style>\n{style}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def _head(title: str) -> str:
    return f"<header><h1>{html.escape(title)}</h1></header>"


def _banner(summary: dict[str, Any]) -> str:
    """One green line, or a red box with the outcome and every reason in words."""
    word = html.escape(summary["outcome"])
    if summary["completed"]:
        return f'<p class="banner good"><strong>Outcome: {word}</strong></p>'
    reasons = "".join(f"<li>{html.escape(reason)}</li>" for reason in summary["reasons"])
    return (
        f'<section class="banner bad" role="alert"><strong>Outcome: {word}. This run is not'
        f" completed.</strong><ul>{reasons}</ul></section>"
    )


def _notes(summary: dict[str, Any]) -> str:
    notes = []
    if summary["log_fault"]:
        notes.append(f"The log is not complete: {summary['log_fault']}.")
    if summary["rejected_messages"]:
        named = ", ".join(f"{count} of {n}" for n, count in summary["rejected_messages"].items())
        notes.append(f"Invalid messages are left out: {named}.")
    if summary["lockstep_timeouts"]:
        notes.append(f"The plant continued without a command {summary['lockstep_timeouts']} times.")
    notes += [f"Incident: {text}." for text in summary["incidents"]]
    notes += [f"Vehicle: {text}." for text in summary["vehicle_warnings"] or ()]
    told = summary["incidents"]
    notes += [
        f"Note of the check: {text}." for text in summary["check"]["notes"] if text not in told
    ]
    if summary["judged_by"] != "ground truth":
        notes.append(f"The limits are judged by {summary['judged_by']}: the log has no truth.")
    return "".join(f'<p class="note">{html.escape(note)}</p>' for note in notes)


def _cards(summary: dict[str, Any]) -> str:
    def of(name: str, part: str, scale: float = 1.0) -> float | None:
        value = summary[name][part]
        return None if value is None else scale * value

    cards = (
        ("end-effector error", of("end_effector_error_m", "rms", 1e3), "mm rms",
         of("end_effector_error_m", "max", 1e3), "mm max"),
        ("navigation error", of("navigation_error_m", "rms", 1e3), "mm rms",
         of("navigation_error_m", "max", 1e3), "mm max"),
        ("roll", of("roll_deg", "max"), "° max", of("roll_deg", "rms"), "° rms"),
        ("pitch", of("pitch_deg", "max"), "° max", of("pitch_deg", "rms"), "° rms"),
        ("least clearance", of("clearance_m", "min", 1e3), "mm",
         (summary["clearance_m"] or {}).get("pair"), ""),
        ("self-disturbance", of("self_disturbance", "moment_rms_nm"), "N m rms",
         of("self_disturbance", "force_rms_n"), "N rms"),
        ("planner step", of("planner_step_ms", "p50"), "ms median",
         of("planner_step_ms", "p99"), "ms p99"),
        ("simulated", summary["sim_duration_s"], "s", summary["real_time_factor"], "× real time"),
    )  # fmt: skip
    return '<section class="cards">' + "".join(_card(*card) for card in cards) + "</section>"


def _card(name: str, first: float | None, unit: str, second: float | None, second_unit: str) -> str:
    below = "" if second is None else f"{_number(second)} {second_unit}"
    return (
        f'<div class="card"><h3>{name}</h3><p class="big">{_number(first)}'
        f'<span> {unit}</span></p><p class="small">{below}</p></div>'
    )


def _number(value: Any) -> str:
    if value is None:
        return "–"
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return html.escape(str(value))
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def _figure(picture: Picture) -> str:
    caption = f"<figcaption>{html.escape(picture.caption)}</figcaption>"
    if picture.file is None:
        reason = html.escape(picture.reason)
        return f'<figure>{caption}<p class="note">No figure: {reason}</p></figure>'
    data = base64.b64encode(picture.file.read_bytes()).decode()
    image = f'<img alt="{html.escape(picture.caption)}" src="data:image/png;base64,{data}">'
    return f'<figure id="{picture.name}">{image}{caption}</figure>'


def _table(values: dict[str, Any]) -> str:
    rows = (
        f"<tr><th>{html.escape(key)}</th><td>{_number(value)}</td></tr>"
        for key, value in values.items()
    )
    return f"<table>{''.join(rows)}</table>"


def _details(name: str, log: RunLog) -> str:
    if name not in log.attachments:
        return ""
    try:
        text = html.escape(log.text(name))
    except LogError as fault:
        text = html.escape(str(fault))
    return f"<details><summary>{name}</summary><pre>{text}</pre></details>"
