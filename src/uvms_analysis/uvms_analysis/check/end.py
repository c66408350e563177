"""What the log says about the run and its end."""

from collections.abc import Iterator

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.finding import END, Finding
from uvms_analysis.errors import LogError
from uvms_core.errors import UvmsError
from uvms_core.vehicle.loader import vehicle_from_yaml


def check_end(contents: Contents) -> Iterator[Finding]:
    """A run without an end, with other programs in it, or without its configuration."""
    if not contents.is_ours:
        text = "no record of a run: the log of another program, checked as far as that goes"
        yield Finding(END, text, serious=False)
        return
    yield from _configuration(contents)
    try:
        end = contents.log.end
    except LogError as fault:
        yield Finding(END, f"the record of the run's end is damaged: {fault}")
        return
    if end is None:
        yield Finding(END, "no record of the run's end: its writer was killed")
        return
    for text in end.foreign:
        yield Finding(END, f"took part without belonging to the run: {text}")
    for text in end.incidents:
        yield Finding(END, text, serious=False)


def _configuration(contents: Contents) -> Iterator[Finding]:
    log = contents.log
    try:
        log.configuration()
        vehicle_from_yaml(log.text("vehicle.yaml"), "its attachment 'vehicle.yaml'")
    except UvmsError as fault:
        yield Finding(END, str(fault).removeprefix(f"log {log.path}: "))
    seed = log.run.get("seed", "")
    if not seed.lstrip("+-").isdigit():
        yield Finding(END, f"the seed {seed!r} is not a number")
