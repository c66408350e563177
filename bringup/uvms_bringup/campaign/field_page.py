"""The page of the trial field: one row a case, with what the baselines reached beside it."""

from collections.abc import Iterator, Mapping
from datetime import date
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.bound import OUTCOME
from uvms_bringup.errors import CampaignError

BEGIN, END = "<!-- table: made by `make field` -->", "<!-- end of table -->"
"""What stands in between is made anew; the text around it is written by hand."""

HEADER = "| case | must be | worst run | baselines, worst run | passed |\n|---|---|---|---|---|"
UNITS = {"_deg": "°", "_m": " m", "_nm": " N m", "_n": " N", "_s": " s"}
NAMES = {
    "roll_deg.max": "roll",
    "pitch_deg.max": "pitch",
    "vehicle_error_m.max": "vehicle off by",
    "vehicle_error_m.end": "vehicle off at the end by",
    "end_effector_tracking_error_m.max": "tool off its path (estimate) by",
    "end_effector_tracking_error_m.end": "tool off its path (estimate) at the end by",
    "end_effector_tracking_error_m.rms": "tool off its path (estimate), rms, by",
    "end_effector_error_m.max": "tool off its path by",
    "navigation_error_m.max": "estimate off by",
    "stability.condition_holds": "share of ticks with the condition below (29)",
    "stability.lyapunov_falls": "share of ticks in which V does not grow",
    "self_disturbance.moment_rms_nm": "self-disturbance, rms",
}
"""Fields of the summary in words."""


def table(summary: Mapping[str, Any], command: str, revision: str, today: date) -> str:
    """What stands between the marks, from a campaign's `summary.json`."""
    cases = summary["cases"]
    whole = [name for name, case in cases.items() if case["passed"] == case["runs"] > 0]
    low, high = (100 * share for share in summary["wilson_95"])
    lines = [
        f"`{command}`, {today.isoformat()}, revision {revision}: {len(whole)} of {len(cases)} cases"
        f" pass with every seed, {summary['passed']} of {summary['runs']} runs"
        f" ({low:.0f}-{high:.0f} %).",
        "",
        HEADER,
        *(row(name, case) for name, case in cases.items()),
    ]
    return "\n".join(lines)


def row(name: str, case: Mapping[str, Any]) -> str:
    """One case: bold where not every run passed."""
    fields = {field: own for field, own in case["fields"].items() if field != OUTCOME}
    passes = case["passed"] == case["runs"] > 0
    beside = "; ".join(
        f"{other}: {_reached(found['fields'], fields)}"
        for other, found in case["baselines"].items()
    )
    low, high = (100 * share for share in case["wilson_95"])
    cells = (
        name if passes else f"**{name}**",
        "; ".join(f"{_word(field)} {_bound(field, own)}" for field, own in fields.items()),
        "; ".join(filter(None, (_worst(case["fields"], fields), _ends(case)))),
        beside,
        f"{case['passed']} of {case['runs']} ({low:.0f}-{high:.0f} %)",
    )
    return f"| {' | '.join(cells)} |"


def _word(field: str) -> str:
    return NAMES.get(field, field)


def _bound(field: str, own: Mapping[str, Any]) -> str:
    words = [f"≥ {_number(field, own['min'])}"] if own["min"] is not None else []
    words += [f"≤ {_number(field, own['max'])}"] if own["max"] is not None else []
    return " and ".join(words) or str(own["bound"])


def _worst(found: Mapping[str, Any], fields: Mapping[str, Any]) -> str:
    """Value and seed of the worst run; bold where it is beyond the bound."""
    texts = []
    for field in fields:
        own = found[field]
        if own.get("worst") is None:
            texts.append("not known")
            continue
        text = _number(field, own["worst"])
        text = f"**{text}**" if own["broken"] else text
        texts.append(f"{text} (seed {own['worst_seed']})")
    return "; ".join(texts)


def _reached(found: Mapping[str, Any], fields: Mapping[str, Any]) -> str:
    """The same of a baseline, without seeds."""
    values = (found[field].get("worst") for field in fields)
    return ", ".join(
        "-" if value is None else _number(field, value)
        for field, value in zip(fields, values, strict=True)
    )


def _ends(case: Mapping[str, Any]) -> str:
    """Runs that did not come to their end as they should, by outcome."""
    others = {word: count for word, count in case["outcomes"].items() if word != "completed"}
    return ", ".join(f"{count} {word}" for word, count in others.items())


def _number(field: str, value: float) -> str:
    """A value with its unit; lengths below half a metre in mm."""
    unit = _unit(field)
    if unit == " m" and abs(value) < 0.5:
        return f"{1e3 * value:.3g} mm"
    return f"{value:.3g}{unit}"


def _unit(field: str) -> str:
    stem = next((part for part in field.split(".") if _suffix(part)), "")
    return UNITS.get(_suffix(stem), "")


def _suffix(name: str) -> str:
    fits = [suffix for suffix in UNITS if name.endswith(suffix)]
    return max(fits, key=len, default="")


def replaced(page: str, content: str, where: str) -> str:
    """The page with `content` between its marks.

    Raises:
        CampaignError: the marks are not there.
    """
    before, begun, rest = page.partition(BEGIN)
    _, ended, after = rest.partition(END)
    if not begun or not ended:
        raise CampaignError(
            f"{where}: needs the lines {BEGIN} and {END}; the table goes in between"
        )
    return f"{before}{BEGIN}\n{content}\n{END}{after}"


def write_page(path: Path, content: str) -> None:
    """Put a new table into the page; raises CampaignError where that is not possible."""
    try:
        page = path.read_text(encoding="utf-8")
        path.write_text(replaced(page, content, str(path)), encoding="utf-8")
    except OSError as fault:
        raise CampaignError(f"{path}: {fault.strerror}") from fault


def lines_of(results: Any) -> Iterator[str]:
    """The cases that do not pass, for the terminal."""
    for name, case in results["cases"].items():
        if case["passed"] < case["runs"]:
            yield f"{name}: {case['passed']} of {case['runs']}"
