"""The summary of a run as a few lines for people; summary.json has all of it."""

from collections.abc import Mapping
from typing import Any

MAXIMA = (
    ("end effector off its target", "end_effector_error_m", 1e3, "mm"),
    ("vehicle off its place", "vehicle_error_m", 1e3, "mm"),
    ("navigation off the truth", "navigation_error_m", 1e3, "mm"),
    ("roll", "roll_deg", 1.0, "deg"),
    ("pitch", "pitch_deg", 1.0, "deg"),
)
"""Words, name in the summary, factor to the unit, unit."""


def summary_text(summary: Mapping[str, Any]) -> str:
    """Outcome with its reasons, duration, and the errors, and incidents."""
    lines = [f"outcome: {summary['outcome']}"]
    lines += [f"  {reason}" for reason in summary.get("reasons") or ()]
    lines.append(_duration(summary))
    for words, name, factor, unit in MAXIMA:
        values = summary.get(name) or {}
        if values.get("max") is not None:
            rms, most = factor * values["rms"], factor * values["max"]
            lines.append(f"{words}: {rms:.3g} {unit} rms, {most:.3g} {unit} at most")
    lines += [f"event: {each['at_s']:g} s: {each['text']}" for each in summary.get("events") or ()]
    later = [each["at_s"] for each in summary.get("events_not_reached") or ()]
    if later:
        times = ", ".join(f"{time:g} s" for time in later)
        lines.append(f"note: the run ended before its events at {times}")
    lines += [f"incident: {text}" for text in summary.get("incidents") or ()]
    return "\n".join(lines)


def _duration(summary: Mapping[str, Any]) -> str:
    if (duration := summary["sim_duration_s"]) is None:
        return f"simulated: unknown, since {summary['missing']['sim_duration_s']}"
    text = f"simulated: {duration:.2f} s in {summary['wall_s']:.1f} s"
    factor = summary.get("real_time_factor")
    return text + (f", {factor:.1f} times real time" if factor else "")
