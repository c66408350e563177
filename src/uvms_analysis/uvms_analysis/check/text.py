"""A check as text: a table of the topics, the findings and the verdict."""

from uvms_analysis.check.run import Check, TopicRow


def as_text(check: Check) -> str:
    """What `uvms check` prints."""
    width = max((len(row.topic) for row in check.rows), default=5)
    head = f"{'topic':{width}}  expected  received   first s    last s"
    lines = [head, *(_line(row, width) for row in check.rows), ""]
    for finding in sorted(check.findings, key=lambda one: not one.serious):
        lines.append(f"{'FAULT' if finding.serious else 'note '}  [{finding.kind}] {finding}")
    span = f"{check.reached_s:g} s"
    if check.asked_s is not None:
        span += f" of {check.asked_s:g} s asked"
    lines.append(f"{check.path}: {check.verdict}, {span}")
    return "\n".join(lines)


def _line(row: TopicRow, width: int) -> str:
    expected = "?" if row.expected is None else str(row.expected)
    first, last = (f"{t:.3f}" if t is not None else "-" for t in (row.first_s, row.last_s))
    mark = "  <- see below" if row.findings else ""
    return f"{row.topic:{width}}  {expected:>8}  {row.received:>8} {first:>9} {last:>9}{mark}"
