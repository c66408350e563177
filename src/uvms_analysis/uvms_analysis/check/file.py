"""The file itself: checksums, structure and index, as the reader found them."""

from collections.abc import Iterator

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.finding import FILE, Finding


def check_file(contents: Contents) -> Iterator[Finding]:
    """What is wrong with the file."""
    for fault in contents.log.faults:
        yield Finding(FILE, fault)
    if not contents.topics:
        yield Finding(FILE, "it has no topic")
    elif not any(topic.stamps for topic in contents.topics.values()):
        yield Finding(FILE, "it has no message")
