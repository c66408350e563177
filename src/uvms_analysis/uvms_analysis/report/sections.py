"""The sections of the page about one run: outcome, figures, tables, plots, everything else."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from uvms_analysis import navigation_check
from uvms_analysis.errors import LogError, determine
from uvms_analysis.log.read import RunLog
from uvms_analysis.report.facts import Facts
from uvms_analysis.report.html import Cell, Raw, escaped, folded, note, number, table
from uvms_analysis.report.metrics import BY_KEY, CARDS, Metric
from uvms_analysis.report.plot import Group
from uvms_analysis.report.shown import PanelShown, Shown


def banner(summary: Mapping[str, Any]) -> str:
    """One green line, or a red box with the outcome and every reason in words."""
    word = escaped(summary["outcome"])
    if summary["completed"]:
        return f'<p class="banner good"><strong>Outcome: {word}</strong></p>'
    reasons = "".join(f"<li>{escaped(reason)}</li>" for reason in summary["reasons"])
    return (
        f'<section class="banner bad" role="alert"><strong>Outcome: {word}. This run is not'
        f" completed.</strong><ul>{reasons}</ul></section>"
    )


def notes(summary: Mapping[str, Any]) -> list[str]:
    """What else should be known before the figures are believed."""
    found = []
    if summary["log_fault"]:
        found.append(f"The log is not complete: {summary['log_fault']}.")
    if summary["rejected_messages"]:
        named = ", ".join(f"{count} of {n}" for n, count in summary["rejected_messages"].items())
        found.append(f"Invalid messages are left out: {named}.")
    if summary["lockstep_timeouts"]:
        found.append(f"The plant continued without a command {summary['lockstep_timeouts']} times.")
    found += [f"Incident: {text}." for text in summary["incidents"]]
    found += [f"Vehicle: {text}." for text in summary["vehicle_warnings"] or ()]
    told = summary["incidents"]
    found += [f"Note of the check: {text}." for text in summary["check"]["notes"]
              if text not in told]  # fmt: skip
    if summary["judged_by"] != "ground truth":
        found.append(f"The limits are judged by {summary['judged_by']}: the log has no truth.")
    return found


def cards(facts: Facts) -> str:
    """The figures of the head."""
    return f'<section class="cards" aria-label="Key figures">{"".join(_cards(facts))}</section>'


def _cards(facts: Facts) -> Iterator[str]:
    for first, second in CARDS:
        metric = BY_KEY[first]
        value = metric.value(facts.values)
        below = "" if second is None else _below(BY_KEY[second], facts)
        unit = "" if value is None else f" <span>{escaped(metric.unit)}</span>"
        shown = "missing" if value is None else number(value)
        kind = "big missing" if value is None else "big"
        yield (
            f'<div class="card"><h3>{escaped(metric.name)}</h3><p class="{kind}">{shown}{unit}</p>'
            f'<p class="small">{below}</p></div>'
        )


def _below(metric: Metric, facts: Facts) -> str:
    value = metric.value(facts.values)
    if value is None:
        return ""
    name = "greatest" if metric.name.endswith(", greatest") else metric.name
    of = "" if metric.limit is None else f" of {metric.limit:g} allowed"
    return escaped(f"{name}: {number(value)} {metric.unit}{of}")


def figures(metrics: Sequence[Metric], facts: Facts) -> str:
    """The figures of a question, each with its unit, and its limit where it has one."""
    if not any(metric.limit for metric in metrics):
        rows = [(metric.name, _value(metric, facts)) for metric in metrics]
        return table(("figure", "value"), rows, kind="figures")
    limited = [(metric.name, _value(metric, facts), _limit(metric, facts)) for metric in metrics]
    return table(("figure", "value", "limit"), limited, kind="figures")


def _value(metric: Metric, facts: Facts) -> Cell:
    value = metric.value(facts.values)
    if value is not None:
        return f"{number(value)} {metric.unit}".strip()
    reason = facts.why_not(metric.key) or "not in the log"
    return Raw(f'<span class="missing">missing: {escaped(reason)}</span>')


def _limit(metric: Metric, facts: Facts) -> Cell:
    if metric.limit is None:
        return ""
    text = f"{number(metric.limit)} {metric.unit}, {metric.rule}"
    value = metric.value(facts.values)
    if value is None:
        return text
    share = min(max(value / metric.limit, 0.0), 1.0)
    over = " over" if value > metric.limit else ""
    bar = f'<span class="bar{over}" aria-hidden="true"><i style="width:{100 * share:.1f}%">'
    return Raw(f"{bar}</i></span>{escaped(text)}")


def plots(groups: Sequence[Group], shown: Shown) -> str:
    """The plots of a question; where one is missing, why."""
    return "".join(_group(group, shown) for group in groups)


def _group(group: Group, shown: Shown) -> str:
    if group.key not in shown.panels and group.key not in shown.missing:
        return ""
    lacking = "".join(note(f"No figure: {text}") for text in shown.missing.get(group.key, ()))
    found = "".join(map(_panel, shown.panels.get(group.key, ())))
    body = f'<p class="caption">{escaped(group.caption)}</p>{lacking}'
    if found:
        body += f'<div class="panels">{found}</div>'
    return folded(group.title, body, group.is_open or not found)


def _panel(panel: PanelShown) -> str:
    remarks = "".join(f'<p class="lack">not shown: {escaped(text)}</p>' for text in panel.notes)
    return (
        f'<figure class="panel" id="plot-{escaped(panel.key)}" data-plot="{escaped(panel.key)}">'
        f"<figcaption>{escaped(panel.title)} <span>({escaped(panel.unit or 'no unit')})</span>"
        "</figcaption>"
        f'<div class="canvas" tabindex="0" role="img" aria-label="{escaped(panel.description)}">'
        f'</div><div class="legend"></div><p class="peaks" hidden></p>{remarks}</figure>'
    )


def goals(summary: Mapping[str, Any]) -> str:
    """What became of each goal."""
    rows = [
        (f"{count}. {goal['kind']}", goal["state"], goal.get("message") or "",
         _seconds(goal["began_s"]), _seconds(goal["ended_s"]))
        for count, goal in enumerate(summary["goals"] or (), start=1)
    ]  # fmt: skip
    return table(("goal", "became", "because", "began", "ended"), rows, "Goals")


def _seconds(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f} s"


def events(summary: Mapping[str, Any]) -> str:
    """What happened to the vehicle, and what the run ended before."""
    rows: list[tuple[str, str]] = [
        (_seconds(event["at_s"]), event["text"]) for event in summary["events"] or ()
    ]
    rows += [(f"{event.get('at_s', 0.0)} s", f"not reached: {event}")
             for event in summary["events_not_reached"] or ()]  # fmt: skip
    found = table(("time", "event"), rows, "Events")
    if plant := summary["plant"]:
        unlike = [(str(key), number(value)) for key, value in _flat(plant)]
        found += table(("plant", "value"), unlike, "How the plant differed from its model")
    return found or "<p>No event is in the log, and the plant was that of the model.</p>"


def _flat(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        if isinstance(value, Mapping):
            yield from ((f"{key}.{inner}", each) for inner, each in _flat(value))
        else:
            yield key, value


def energy(summary: Mapping[str, Any]) -> str:
    """Electrical energy of each thruster; nothing where it is not known."""
    total, each = summary["energy"]["total_wh"], summary["energy"].get("thrusters_wh") or {}
    rows = [
        (
            name,
            f"{number(value)} Wh",
            f"{number(100.0 * value / total)} %" if total else number(None),
        )
        for name, value in each.items()
    ]
    return table(("thruster", "electrical energy", "of all"), rows, "Energy of the thrusters")


def health(log: RunLog, summary: Mapping[str, Any]) -> str:
    """Sensors, thrusters, counters of the nodes, errors, and what the check of the log found."""
    return "".join((
        _sensors(log), _thrusters(summary), _counters(summary), _errors(summary), _check(summary)
    ))  # fmt: skip


def _sensors(log: RunLog) -> str:
    try:
        found = determine(lambda: navigation_check.sensors(log))
    except LogError as fault:
        return note(f"Sensors: missing: {fault}")
    rows = [
        (name, *(number(None if said[key] != said[key] else said[key])
                 for key in navigation_check.KEYS))
        for name, said in found.items()
    ]  # fmt: skip
    head = ("sensor", "samples used", "samples rejected", "residuals at the end (NIS, 1 is right)")
    return table(head, rows, "Sensors, as navigation last said")


def _thrusters(summary: Mapping[str, Any]) -> str:
    faults = summary["thruster_faults"] or {}
    if "thruster_faults" in (summary.get("missing") or {}):
        return note(f"Thrusters: missing: {summary['missing']['thruster_faults']}")
    if not faults:
        return "<p>Thrusters: none was taken for weak.</p>"
    rows = [
        (name, f"{100 * fault['effectiveness']:.0f} %", _seconds(fault["at_s"]),
         _seconds(fault["until_s"]))
        for name, fault in faults.items()
    ]  # fmt: skip
    return table(("thruster", "least share of its command", "from", "until"), rows,
                 "Thrusters that were taken for weak")  # fmt: skip


def _counters(summary: Mapping[str, Any]) -> str:
    counters = summary["node_counters"]
    if counters is None:
        return note("Nodes: missing: nobody says on /diagnostics what it has counted")
    rows = [
        (role, key.replace("_", " "), number(count))
        for role, counts in counters.items()
        for key, count in counts.items()
        if count
    ]
    if not rows:
        return "<p>Nodes: nothing was refused, held, late or unsafe.</p>"
    return table(("node", "what", "count"), rows, "What the nodes counted")


def _errors(summary: Mapping[str, Any]) -> str:
    rows = [(role, _seconds(at)) for role, at in (summary["errors_first_s"] or {}).items()]
    return table(("node", "first ERROR on /diagnostics"), rows, "Errors")


def _check(summary: Mapping[str, Any]) -> str:
    check = summary["check"]
    rows = [("verdict", check["verdict"])]
    rows += [("fault", text) for text in check["faults"]]
    rows += [("note", text) for text in check["notes"]]
    return table(("check of the log", "finding"), rows, "Is the log complete?")
