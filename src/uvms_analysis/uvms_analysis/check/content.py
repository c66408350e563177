"""The messages: valid signals, of the type that their topic promises, at their own stamps."""

from collections.abc import Iterator

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.finding import CONTENT, Finding


def check_content(contents: Contents) -> Iterator[Finding]:
    """Topics that cannot be read, and messages that are refused."""
    for name, reason in contents.unusable.items():
        yield Finding(CONTENT, f"cannot be read: {reason}", name, serious=contents.is_ours)
    for name, found in contents.topics.items():
        if found.rejected:
            text = f"{len(found.rejected)} invalid messages, the first at {found.rejected[0]}"
            yield Finding(CONTENT, text, name, serious=contents.is_ours)
        if found.moved:
            text = f"{found.moved} messages are recorded at another time than their own stamp"
            yield Finding(CONTENT, text, name, serious=contents.is_ours)
