"""The messages: valid signals, of the type that their topic promises, at their own stamps."""

from collections.abc import Iterator

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.finding import CONTENT, Finding
from uvms_analysis.errors import LogError


def check_content(contents: Contents) -> Iterator[Finding]:
    """Topics that cannot be read, and messages that are refused."""
    for name, reason in contents.unusable.items():
        yield Finding(CONTENT, f"cannot be read: {reason}", name, serious=contents.is_ours)
    for name, found in contents.topics.items():
        if found.rejected:
            text = f"{len(found.rejected)} invalid messages, the first at {found.rejected[0]}"
            yield Finding(CONTENT, text, name, serious=contents.is_ours)
        if found.names and (lack := _other_names(contents, found.names)):
            yield Finding(CONTENT, lack, name)
        if found.moved:
            text = f"{found.moved} messages are recorded at another time than their own stamp"
            yield Finding(CONTENT, text, name, serious=contents.is_ours)


def _other_names(contents: Contents, names: tuple[str, ...]) -> str:
    """How the names in a message differ from those of the log's vehicle; empty where they do not.

    Another order is a finding, too: the figures take the values in the vehicle's.
    """
    try:
        vehicle = contents.log.vehicle
    except LogError:
        return ""
    known = (vehicle.joint_names, vehicle.thruster_names)
    if sorted(names) in [sorted(each) for each in known]:
        return "" if names in known else f"its names are in another order: {', '.join(names)}"
    return f"its names {', '.join(names)} are neither the joints nor the thrusters of vehicle.yaml"
