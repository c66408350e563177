"""What a log is: whose run, how long, how it ended, what it carries."""

from typing import Any

from uvms_analysis.analysis import Analysis
from uvms_analysis.energy import battery_series
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.overview.topic_rows import TopicRow, rows_text

MEGABYTE = 1e6


def log_info(log: RunLog, rows: list[TopicRow]) -> dict[str, Any]:
    """The facts by name, as JSON has them; what the log does not say is left out."""
    firsts = [row.first_s for row in rows if row.first_s is not None]
    lasts = [row.last_s for row in rows if row.last_s is not None]
    facts: dict[str, Any] = {
        "log": str(log.path),
        "size_mb": log.path.stat().st_size / MEGABYTE,
        "messages": sum(row.messages for row in rows),
        "topics": len(rows),
        "fault": log.fault,
    }
    if firsts:
        facts |= {"first_s": min(firsts), "last_s": max(lasts)}
    return facts | {"run": log.run} | _vehicle(log) | _battery(log) | _end(log)


def info_text(log: RunLog, facts: dict[str, Any], rows: list[TopicRow]) -> str:
    """The facts as lines, then a table of the topics."""
    lines = [f"{facts['log']}: {facts['size_mb']:.1f} MB, {facts['messages']} messages"]
    lines += [f"FAULT: {facts['fault']}"] if facts["fault"] else []
    if "first_s" in facts:
        lines.append(_line("time", f"{facts['first_s']:.6g} s to {facts['last_s']:.6g} s"))
    lines += [_line(name, value) for name, value in facts["run"].items() if value]
    lines += [_line(name, facts[name]) for name in ("vehicle", "thrusters", "joints", "goal")
              if name in facts]  # fmt: skip
    lines += [_line("battery", _battery_text(facts["battery"]))] if "battery" in facts else []
    lines += [_line("stopped by", facts["stopped_by"])] if facts.get("stopped_by") else []
    lines += [_line("incident", each) for each in facts.get("incidents", ())]
    if log.attachments:
        lines.append(_line("attachments", ", ".join(log.attachments)))
    return "\n".join([*lines, "", rows_text(rows)])


def _vehicle(log: RunLog) -> dict[str, Any]:
    try:
        vehicle = log.vehicle
    except LogError:
        return {}  # of somebody else's log, which has none
    return {
        "vehicle": vehicle.name,
        "thrusters": ", ".join(each.name for each in vehicle.thrusters),
        "joints": ", ".join(vehicle.joint_names),
    }


def _battery(log: RunLog) -> dict[str, Any]:
    """Share of the charge and voltage at the first and at the last sample."""
    try:
        said = battery_series(Analysis(log))
    except LogError:
        return {}
    return {
        "battery": {
            "first": float(said.percentage[0]),
            "last": float(said.percentage[-1]),
            "voltage_v": float(said.voltage[-1]),
        }
    }


def _battery_text(battery: dict[str, float]) -> str:
    return (
        f"{battery['first']:.2%} to {battery['last']:.2%}, at the end {battery['voltage_v']:.4g} V"
    )


def _end(log: RunLog) -> dict[str, Any]:
    end = log.end
    if end is None:
        return {}
    return {"goal": end.goal, "stopped_by": end.stopped_by, "incidents": list(end.incidents)}


def _line(name: str, value: object) -> str:
    return f"  {name:16} {value}"
